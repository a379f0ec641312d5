// The lines of names and of units above a table.
#include <algorithm>
#include <optional>
#include <utility>

#include "engine/base/text.h"
#include "engine/import/table_parts.h"

namespace palpate {
namespace {

// A header is at most this many lines above the numbers: units, a type, a rule, the status of a board may follow it.
constexpr std::size_t kReach = 12;
// A line with names of so many roles is a header.
constexpr int kNamedRoles = 2;

// Removes the mark of a comment before the names.
std::string_view without_comment_mark(std::string_view line) {
  line = trimmed(line);
  const std::size_t begin = line.find_first_not_of("#%/");
  // "%time" is a name of ROS, and a lone mark is a name of a column of row numbers.
  if (begin == std::string_view::npos || (begin == 1 && line.front() == '%' && line.find_first_of(" \t") > 5))
    return line;
  return trimmed(line.substr(begin));
}

// Splits a line of names: by the separator of the table; at wide gaps, or before words without units in brackets, where
// that is blanks; as one of R, whose row numbers have no name; or by any other separator. The fields are those of the
// first of these that gives a name for each column; without one those of the separator. `own`: not by another one.
bool split_names(std::string_view line, std::string_view first_row, const TableLayout& layout, Fields& names,
                 bool& own) {
  const std::string_view bare = without_comment_mark(line);
  const bool blanks = layout.delimiter.is_blanks();
  own = true;
  const auto fits = [&] { return blanks ? names.size() == layout.columns : names.size() >= layout.columns; };
  for (const std::string_view text : {line, bare}) {
    split_table_fields(text, layout.delimiter, names);
    if (fits()) return true;
    if (!blanks) continue;
    const Fields words = names;
    names.clear();
    for (std::string_view rest = text; !(rest = trimmed(rest)).empty();) {
      const std::size_t end = std::min({rest.find("  "), rest.find('\t'), rest.size()});
      names.push_back(trimmed(rest.substr(0, end)));
      rest.remove_prefix(end);
    }
    if (fits()) return true;
    names.clear();
    for (const std::string_view word : words) {
      if (names.empty() || (!word.starts_with('[') && !word.starts_with('(')))
        names.push_back(word);
      else
        names.back() = {names.back().data(), static_cast<std::size_t>(word.data() + word.size() - names.back().data())};
    }
    if (fits()) return true;
  }
  Fields row;
  split_table_fields(first_row, layout.delimiter, row);
  split_table_fields(line, layout.delimiter, names);
  if (!row.empty() && row.front() == "1" && names.size() + 1 == layout.columns) {
    names.insert(names.begin(), std::string_view());
    return true;
  }
  own = false;
  for (const Delimiter& other : kDelimiters) {
    split_table_fields(bare, other, names);
    if (names.size() == layout.columns) return true;
  }
  own = true;
  split_table_fields(bare, layout.delimiter, names);
  return false;
}

bool is_names_row(const Fields& fields) {
  std::size_t names = 0;
  for (const std::string_view field : fields) {
    double value = 0.0;
    const bool has_letter = std::any_of(field.begin(), field.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || static_cast<unsigned char>(c) >= 0x80;
    });
    if (has_letter && !parse_table_number(field, '.', value)) ++names;
  }
  return names >= 2;
}

struct UnitCount {
  std::size_t known = 0;  // of time, length or force
  std::size_t others = 0, words = 0;

  bool decides() const { return known > 0 && known + others >= 2 && known + others > words; }
};

UnitCount count_units(const Fields& fields) {
  UnitCount count;
  for (const std::string_view field : fields) {
    if (field.empty() || field == "-" || field == "[]" || field == "[-]") continue;
    const bool bracketed = field.size() > 2 && (field.front() == '[' || field.front() == '(');
    ++(find_unit(field) ? count.known : bracketed || is_other_unit(field) ? count.others : count.words);
  }
  return count;
}

// Text files of LabVIEW have the units of the columns above the table and, if the table has no times, the interval and
// the first time of each channel.
void read_labview_head(const std::vector<std::string_view>& lines, std::size_t first, TableLayout& layout) {
  Fields fields;
  bool times = true;
  const auto numbers = [&] {
    std::vector<double> values(fields.size(), 0.0);
    for (std::size_t i = 1; i < fields.size(); ++i) parse_table_number(fields[i], layout.decimal, values[i]);
    return values;
  };
  for (std::size_t i = 0; i < first; ++i) {
    const std::string_view line = lines[i];
    if (line.empty() || (line.front() != 'Y' && line.front() != 'X' && line.front() != 'D')) continue;
    if (split_table_fields(line, layout.delimiter, fields) < 2 || fields.size() < 2) continue;
    if (fields[0] == "Y_Unit_Label") {
      layout.units = fields;
      layout.units[0] = {};
    }
    if (fields[0] == "X_Columns") times = fields[1] != "No";
    if (fields[0] == "Delta_X") layout.steps_s = numbers();
    if (fields[0] == "X0") layout.starts_s = numbers();
  }
  if (times) layout.steps_s.clear();
}

}  // namespace

void find_table_header(const std::vector<std::string_view>& lines, std::size_t first, TableLayout& layout) {
  // The nearest line of each kind: with names of at least two roles; the same, but without one of each column; with
  // any words; of units alone.
  enum { named, misfit, words, units, kinds };
  std::array<Fields, kinds> fields;
  std::array<std::size_t, kinds> line{};  // from 1
  std::size_t seen = 0;
  Fields row;
  for (std::size_t i = first; i-- > 0 && seen < kReach;) {
    if (trimmed(lines[i]).empty()) continue;
    const bool end_of_head = lines[i].starts_with("***");  // of LabVIEW, whose head names the axis
    if (end_of_head || is_row(layout, lines[i], row)) {
      if (line[named] > 0) break;
      continue;  // a second block may share the header of the first
    }
    ++seen;
    Fields names;
    bool own = true;
    const bool split = split_names(lines[i], lines[first], layout, names, own);
    const NamedRoles roles = named_roles(names);
    // Names beyond the columns are those of remarks, but not of a role.
    const bool fits = split && std::ranges::none_of(roles.column, [&](auto column) { return column > layout.widest; });
    const UnitCount count = count_units(names);
    const bool below = line[named] == 0;
    std::size_t kind = kinds;
    if (fits && (count.decides() || (count.known >= 2 && roles.count == 0 && below)))
      kind = units;
    else if (is_names_row(names) && fits && roles.count >= kNamedRoles)
      kind = named;
    else if (is_names_row(names) && roles.count >= kNamedRoles)
      kind = misfit;
    else if (is_names_row(names) && fits && own)
      kind = words;
    if (kind == named && line[named] > 0 && names != fields[named]) layout.rival = i + 1;
    if (kind == kinds || line[kind] > 0) continue;
    line[kind] = i + 1;
    fields[kind] = std::move(names);
  }
  const auto header = std::ranges::find_if(line, [](std::size_t number) { return number > 0; }) - line.begin();
  if (header < kinds) {
    layout.header = line[static_cast<std::size_t>(header)];
    layout.names = fields[static_cast<std::size_t>(header)];
    layout.misfit = header == misfit;
    if (layout.misfit) return;
    layout.columns = std::clamp(layout.names.size(), layout.columns, layout.widest);
    layout.names.resize(layout.columns);
    if (line[units] >= layout.header) layout.units = fields[units];
  }
  read_labview_head(lines, first, layout);
}

}  // namespace palpate
