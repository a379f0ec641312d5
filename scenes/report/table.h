// The tables of the report: one description for the CSV file, the page and report.json.
// Thread guarantee: value types and pure functions.
#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "scenes/report/measure.h"

namespace palpate {

// The format of a column on the page. CSV and report.json have the SI value in full precision.
struct TableColumn {
  std::string key;     // CSV header and JSON key with the unit at its end: "rms_error_N"
  std::string title;   // header on the page with the displayed unit: "RMS [mN]"; empty: not on the page
  double scale = 1.0;  // displayed value / stored value
  int decimals = kThreeDigits;
  int under = 0;  // the next column (1), or the next two as an interval (2), are displayed below this value

  static constexpr int kThreeDigits = -1;  // three significant digits
};

// Text, a count, a truth value, or a number. A number that is not finite becomes an empty cell, null in JSON, a dash on
// the page.
using TableCell = nlohmann::ordered_json;
inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInPercent = 100.0;
inline constexpr double kInMilli = 1e3;

struct Table {
  std::string name;        // of the CSV file, without extension
  bool has_times = false;  // contains measured times, which differ from run to run
  std::vector<TableColumn> columns{};
  std::vector<std::vector<TableCell>> rows{};  // as many cells as columns

  void begin_row() { rows.emplace_back(); }
  // Adds the next cell of the last row. The first row defines the columns.
  void add(const TableColumn& column, TableCell cell) {
    if (rows.size() == 1) columns.push_back(column);
    rows.back().push_back(std::move(cell));
  }
  // Adds mean_KEY, std_KEY and max_KEY, which are not on the page.
  void add_moments(const std::string& key, const Moments& values) {
    add({"mean_" + key, ""}, values.mean());
    add({"std_" + key, ""}, values.deviation());
    add({"max_" + key, ""}, values.largest());
  }
};

// Numbers read back as the same doubles; text is quoted where needed (RFC 4180).
std::string table_csv(const Table& table);

// A list of objects, one per row.
nlohmann::ordered_json table_json(const Table& table);

// The cells as on the page, the titles first.
std::vector<std::vector<std::string>> table_text(const Table& table);

// <div><table>...</table></div> with all text escaped.
std::string table_html(const Table& table);

// The first table of the page, which the terminal shows too: the models of headline_models.
Table headline_table(const ReportData& data);

// All numbers of a report: the tables models, recordings, force_bins, features and times.
std::vector<Table> make_tables(const ReportData& data);

}  // namespace palpate
