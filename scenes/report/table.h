// The tables of the report: one description for the CSV file, the page and report.json.
// Thread guarantee: value types and pure functions.
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/text.h"
#include "scenes/report/measure.h"

namespace palpate {

// How the page shows a column; the CSV and report.json always hold the SI value in full.
struct TableColumn {
  std::string key;     // CSV header and JSON key, unit at its end: "rms_error_N"
  std::string title;   // on the page, with the unit in which it is shown: "RMS [mN]"; empty: not shown
  double scale = 1.0;  // shown = stored x scale
  int decimals = kThreeDigits;
  int under = 0;  // so many of the next columns are shown under it: one as it is, two as an interval

  static constexpr int kThreeDigits = -1;  // three significant digits
};

// Text, a count, or a number; a number that is not finite is "no figure": an empty
// cell, null in JSON, a dash on the page.
using TableCell = nlohmann::ordered_json;
inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
// Scales of columns.
inline constexpr double kInPercent = 100.0;
inline constexpr double kInMilli = 1e3;

struct Table {
  std::string name;        // of the CSV file, without its ending
  bool has_times = false;  // holds measured times: differs from run to run
  std::vector<TableColumn> columns{};
  std::vector<std::vector<TableCell>> rows{};  // as many cells as columns

  void begin_row() { rows.emplace_back(); }
  // The next cell of the row begun last; the first row makes the columns.
  void add(const TableColumn& column, TableCell cell) {
    if (rows.size() == 1) columns.push_back(column);
    rows.back().push_back(std::move(cell));
  }
};

// Numbers read back as the same doubles; text is quoted where needed (RFC 4180).
std::string table_csv(const Table& table);

// A list of objects, one a row.
nlohmann::ordered_json table_json(const Table& table);

// <div><table>...</table></div>, everything from outside escaped; numbers to the right.
std::string table_html(const Table& table);

// What its intervals resample: "recording" or "stroke".
const char* unit_name(const Evidence& errors);

// All numbers of a report: models, recordings, force_bins, features, times; those with times
// differ from run to run.
std::vector<Table> make_tables(const ReportData& data);

}  // namespace palpate
