#include "scenes/report/table.h"

#include <cmath>

#include "engine/base/csv_scanner.h"
#include "scenes/plot/inline_svg.h"

namespace palpate {
namespace {

std::string quoted_if_needed(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted(1, '"');
  for (const char letter : text) {
    if (letter == '"') quoted += '"';
    quoted += letter;
  }
  return quoted + '"';
}

std::string csv_cell(const TableCell& cell) {
  if (cell.kind == TableCell::Kind::text) return quoted_if_needed(cell.text);
  if (cell.kind == TableCell::Kind::count) return std::to_string(cell.count);
  return std::isfinite(cell.number) ? shortest(cell.number) : "";
}

std::string shown(const TableCell& cell, const TableColumn& column) {
  if (cell.kind == TableCell::Kind::text) return escape_html(cell.text);
  if (cell.kind == TableCell::Kind::count) return with_thousands(std::to_string(cell.count));
  const double value = cell.number * column.scale;
  if (!std::isfinite(value)) return "–";
  return column.decimals == TableColumn::kThreeDigits ? three_digits(value)
                                                      : with_thousands(fixed(value, column.decimals));
}

std::string interval_html(const TableCell& low, const TableCell& high, const TableColumn& column) {
  if (!std::isfinite(low.number) || !std::isfinite(high.number)) return {};
  return "<small>" + shown(low, column) + "–" + shown(high, column) + "</small>";
}

bool is_text(const Table& table, std::size_t column) {
  for (const auto& row : table.rows) {
    if (row[column].kind != TableCell::Kind::text) return false;
  }
  return !table.rows.empty();
}

}  // namespace

std::string table_csv(const Table& table) {
  std::string text;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (i > 0) text.push_back(',');
    text += table.columns[i].key;
  }
  text.push_back('\n');
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {  // a row without cells is a blank line
      if (i > 0) text.push_back(',');
      text += csv_cell(row[i]);
    }
    text.push_back('\n');
  }
  return text;
}

nlohmann::ordered_json table_json(const Table& table) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& row : table.rows) {
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < row.size(); ++i) {
      nlohmann::ordered_json& value = object[table.columns[i].key];
      switch (row[i].kind) {
        case TableCell::Kind::text:
          value = row[i].text;
          break;
        case TableCell::Kind::count:
          value = row[i].count;
          break;
        case TableCell::Kind::number:
          value = row[i].number;
          break;  // not finite: dumped as null
      }
    }
    list.push_back(std::move(object));
  }
  return list;
}

std::string table_html(const Table& table) {
  std::string html = "<div class=\"table\"><table>\n<thead><tr>";
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (table.columns[i].title.empty()) continue;
    html += is_text(table, i) ? "<th class=\"text\">" : "<th>";
    html += escape_html(table.columns[i].title) + "</th>";
  }
  html += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const TableColumn& column = table.columns[i];
      if (column.title.empty()) continue;
      html += is_text(table, i) ? "<td class=\"text\">" : "<td>";
      html += shown(row[i], column);
      if (column.has_interval) html += interval_html(row[i + 1], row[i + 2], column);
      html += "</td>";
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace palpate
