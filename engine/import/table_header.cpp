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
// Two lines with different names for position and force are rivals, unless the names of one are stronger by more than
// this, which is the strength of a unit.
constexpr int kClearStrength = 3;

// Removes the mark of a comment before the names.
std::string_view without_comment_mark(std::string_view line) {
  line = trimmed(line);
  const std::size_t begin = line.find_first_not_of("#%/");
  // "%time" is a name of ROS, and a lone mark is a name of a column of row numbers.
  if (begin == std::string_view::npos || (begin == 1 && line.front() == '%' && line.find_first_of(" \t") > 5))
    return line;
  return trimmed(line.substr(begin));
}

// In a header separated by blanks, joins units in brackets with the name before.
void join_bracketed(Fields& fields) {
  std::size_t kept = 0;
  for (const std::string_view field : fields) {
    if (kept > 0 && (field.front() == '[' || field.front() == '(')) {
      std::string_view& last = fields[kept - 1];
      last = std::string_view(last.data(), static_cast<std::size_t>(field.data() + field.size() - last.data()));
    } else {
      fields[kept++] = field;
    }
  }
  fields.resize(kept);
}

void split_at_wide_gaps(std::string_view line, Fields& fields) {
  fields.clear();
  while (!(line = trimmed(line)).empty()) {
    const std::size_t end = std::min(line.find("  "), line.find('\t'));
    fields.push_back(trimmed(line.substr(0, end)));
    line.remove_prefix(std::min(end, line.size()));
  }
}

// Splits a line of names: by the separator of the table, as one of R, whose row numbers have no name, or by any other
// separator that gives a name for each column. Returns which of these; none: the fields are those of the first.
enum class Split { own, other, none };
Split split_names(std::string_view line, std::string_view first_row, const TableLayout& layout, Fields& fields) {
  const std::string_view bare = without_comment_mark(line);
  const bool blanks = layout.delimiter.is_blanks();
  const auto fits = [&] { return blanks ? fields.size() == layout.columns : fields.size() >= layout.columns; };
  for (const std::string_view text : {line, bare}) {
    split_table_fields(text, layout.delimiter, fields);
    if (fits()) return Split::own;
    if (!blanks) continue;
    split_at_wide_gaps(text, fields);
    if (fits()) return Split::own;
    split_table_fields(text, layout.delimiter, fields);
    join_bracketed(fields);
    if (fits()) return Split::own;
  }
  Fields row, names;
  split_table_fields(first_row, layout.delimiter, row);
  split_table_fields(line, layout.delimiter, names);
  if (!row.empty() && row.front() == "1" && names.size() + 1 == layout.columns) {
    fields = std::move(names);
    fields.insert(fields.begin(), std::string_view());
    return Split::own;
  }
  for (const Delimiter& other : kDelimiters) {
    split_table_fields(bare, other, names);
    if (names.size() != layout.columns) continue;
    fields = std::move(names);
    return Split::other;
  }
  return Split::none;
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

// A line above the table.
struct Line {
  std::uint64_t number = 0;  // from 1
  Fields fields;
  bool fits = true;  // a field for each column
  bool own = true;   // split by the separator of the table
  NamedRoles roles;
  UnitCount units;

  bool is_named() const { return fits && roles.count >= kNamedRoles; }
  bool is_units() const { return fits && units.decides(); }
  // A line below the names with some units is a line of units, too.
  bool has_units() const { return is_units() || (fits && units.known >= 2 && roles.count == 0); }

  int rank() const {
    if (is_named()) return own ? 4 : 3;
    if (fits) return 1;
    return roles.count == static_cast<int>(kRoles) ? 2 : 0;
  }
  bool better_than(const Line& other) const {
    if (rank() != other.rank()) return rank() > other.rank();
    return is_named() && roles.strength > other.roles.strength;
  }
};

Line read_line(std::string_view text, std::string_view first_row, const TableLayout& layout) {
  Line line;
  const Split split = split_names(text, first_row, layout, line.fields);
  line.own = split != Split::other;
  line.roles = named_roles(line.fields);
  // Names beyond the columns are those of remarks, but not of a role.
  const auto beyond = [&](std::size_t column) { return column > layout.widest; };
  line.fits = split != Split::none && std::ranges::none_of(line.roles.column, beyond);
  line.units = count_units(line.fields);
  return line;
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
  std::vector<Line> candidates;  // the nearest first
  std::optional<Line> units;
  std::size_t seen = 0;
  Fields row;
  for (std::size_t i = first; i-- > 0 && seen < kReach;) {
    // A second block may share the header of the first.
    if (trimmed(lines[i]).empty() || is_row(layout, lines[i], row)) continue;
    ++seen;
    Line line = read_line(lines[i], lines[first], layout);
    line.number = i + 1;
    if (line.is_units()) {
      if (!units) units = std::move(line);
    } else if (is_names_row(line.fields) && ((line.fits && line.own) || line.roles.count >= kNamedRoles)) {
      candidates.push_back(std::move(line));
    }
  }
  const Line* header = nullptr;
  for (const Line& line : candidates)
    if (header == nullptr || line.better_than(*header)) header = &line;
  if (header == nullptr) header = units ? &*units : nullptr;  // the units are the only names
  if (header != nullptr) {
    if (units && units->number < header->number) units.reset();
    for (const Line& line : candidates) {
      if (&line == header) break;
      if (!units && header->is_named() && line.has_units()) units = line;
    }
    layout.header = header->number;
    layout.names = header->fields;
    layout.misfit = !header->fits;
    if (layout.misfit) return;
    layout.columns = std::clamp(layout.names.size(), layout.columns, layout.widest);
    layout.names.resize(layout.columns);
    if (units) layout.units = units->fields;
    for (const Line& line : candidates) {
      const bool weaker = header->roles.strength - line.roles.strength > kClearStrength;
      if (line.is_named() && !weaker && header->roles.contradicts(line.roles)) layout.rival = line.number;
    }
  }
  read_labview_head(lines, first, layout);
}

}  // namespace palpate
