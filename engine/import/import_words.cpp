#include "engine/import/import_words.h"

#include <filesystem>

#include "engine/base/csv_scanner.h"

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
         std::string(encoding_name(table.encoding)) + ", " +
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
  for (const std::string& flip : flipped_roles(request)) comments.push_back(flip + ": sign turned round");
  return comments;
}

}  // namespace palpate
