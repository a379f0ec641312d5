#include "engine/import/import_words.h"

#include <cmath>
#include <filesystem>

#include "engine/base/csv_scanner.h"
#include "engine/base/text.h"

namespace palpate {

std::string decimal_name(const TableLayout& layout) { return layout.decimal == ',' ? "comma" : "point"; }

std::string column_words(const ImportedColumn& column) {
  if (column.number == 0) return "from --rate";
  const std::string name = column.header.empty() ? "" : " \"" + printable(column.header) + "\"";
  return "column " + std::to_string(column.number) + name + " in " + column.unit + (column.guessed ? " (guessed)" : "");
}

std::string table_words(const ImportedTable& table) {
  const TableLayout& layout = table.layout;
  return std::string(delimiter_name(layout.delimiter)) + " between fields, decimal " + decimal_name(layout) + ", " +
         std::string(table.encoding) + ", " +
         (layout.header_line > 0 ? "header in line " + std::to_string(layout.header_line) : "no header") +
         ", numbers from line " + std::to_string(layout.data_line);
}

std::vector<std::string> flipped_roles(const ImportRequest& request) {
  std::vector<std::string> flips;
  if (request.flip_position) flips.emplace_back("position");
  if (request.flip_force) flips.emplace_back("force");
  return flips;
}

std::vector<std::string> import_origin(const std::string& file, const ImportRequest& request,
                                       const ImportedTable& table) {
  std::vector<std::string> comments = {"imported by palpate import from " +
                                       std::filesystem::path(file).filename().string()};
  for (std::size_t role = 0; role < kRoles; ++role) {
    comments.push_back(std::string(kRoleNames[role]) + ": " + column_words(table.columns[role]));
  }
  for (const std::string& flip : flipped_roles(request)) comments.push_back(flip + ": sign reversed");
  return comments;
}

std::string short_number(double value) { return general(value, 6); }

std::string count_of(std::uint64_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string time_fault_words(const std::string& quoted_name, double time_s, double last_time_s, std::size_t rows) {
  const std::string what = "found a time " + short_number(last_time_s - time_s) + " s before that of the row above";
  // The mean rate of the rows so far.
  const std::string rate = rows > 2 && last_time_s > 0.0
                               ? short_number(std::round(static_cast<double>(rows - 1) / last_time_s))
                               : std::string("HZ");
  const std::string advice =
      "split the file there, or sort its rows; if the rows are evenly spaced, add --rate " + rate;
  return what + quoted_name + ", expected later times in every row; " + advice;
}

std::string size_fault_words(const RecordingRow& row, const ImportedColumn& column, std::size_t role,
                             const std::string& quoted_name) {
  const bool force = role == 2;
  return std::string("found a ") + kRoleNames[role] + " of " + short_number(force ? row.force_N : row.position_m) +
         (force ? " N" : " m") + " (column " + std::to_string(column.number) + quoted_name + " in " + column.unit +
         "), expected at most " + (force ? "1000000 N" : "1 m") + "; check the unit and give it with --units " +
         (force ? "mN" : "mm") + ", or choose another column";
}

}  // namespace palpate
