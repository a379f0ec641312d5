// The separator and the decimal mark of a table, its blocks of rows, and the lines of names and of units above them.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "engine/base/text.h"
#include "engine/import/table_parts.h"

namespace palpate {
namespace {

// The lines on which separator and decimal mark are tried. Preambles of testing machines are some hundred lines long.
constexpr std::size_t kSampleLines = 2000;
// Fewer rows with more fields than the others are damaged or have remarks.
constexpr std::size_t kRowsOfAWidth = 5;
// So many rows of another length in sequence are a block of their own; fewer are damaged rows.
constexpr std::size_t kOtherRows = 5;
// A header is at most this many lines above the numbers: units, a type, a rule, the status of a board may follow it.
constexpr std::size_t kReach = 12;
// A line with names of so many roles is a header.
constexpr int kNamedRoles = 2;

// What the fields of a line are.
struct LineShape {
  std::size_t fields = 0;                                       // empty ones included
  std::size_t numbers = 0, clocks = 0, missing = 0, words = 0;  // the clocks are numbers, too
  std::size_t last_number = 0;                                  // from 1
  bool first_is_word = false;

  bool is_row() const { return numbers > 0 && numbers + missing >= 2 && numbers + missing >= words; }
};

// `fields` is set to the fields of the line.
LineShape shape_of(std::string_view line, const Delimiter& delimiter, char decimal, Fields& fields) {
  LineShape shape{split_table_fields(line, delimiter, fields)};
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].empty()) continue;
    const bool number = parse_table_cell(fields[i], decimal).has_value(), clock = !number && is_of_a_clock(fields[i]);
    if (clock) ++shape.clocks;
    if (number || clock) shape.last_number = i + 1;
    ++(number || clock ? shape.numbers : is_missing_value(fields[i]) ? shape.missing : shape.words);
    if (i == 0) shape.first_is_word = shape.words > 0;
  }
  return shape;
}

// How well a separator and a decimal mark fit: whether no field begins like a number without being one, and the numbers
// in the longest run of rows.
std::pair<bool, std::size_t> fit_of(Lines lines, const Delimiter& delimiter, char decimal) {
  std::pair<std::size_t, std::size_t> best, run;  // numbers, and the fields that begin like one and are none
  Fields fields;
  for (std::size_t i = 0; i < std::min(lines.size(), kSampleLines); ++i) {
    if (trimmed(lines[i]).empty()) continue;
    const LineShape shape = shape_of(lines[i], delimiter, decimal, fields);
    if (!shape.is_row()) {
      run = {};
      continue;
    }
    run.first += shape.numbers + shape.missing;
    run.second += static_cast<std::size_t>(std::ranges::count_if(fields, [&](std::string_view field) {
      return field.find_first_of("0123456789") < 2 &&
             field.find_first_not_of("0123456789.,;+-eE \t") == std::string_view::npos &&
             std::ranges::count(field, '-') < 2 &&  // of a date
             !parse_table_cell(field, decimal) && !is_of_a_clock(field) && !is_missing_value(field);
    }));
    if (run.first > best.first) best = run;
  }
  return {best.second == 0, best.first};
}

// Refuses numbers whose decimal mark may be one of thousands in every cell: "1,234", but not "0,123" or "1,5".
Status check_decimal_mark(Lines lines, const TableLayout& layout) {
  Fields fields;
  std::string example;
  for (const std::string_view line : lines) {
    if (!is_row(layout, line, fields)) continue;
    for (std::string_view field : fields) {
      double value = 0.0;
      if (field.find(layout.decimal) == std::string_view::npos || !parse_table_number(field, layout.decimal, value))
        continue;
      if (field.front() == '-' || field.front() == '+') field.remove_prefix(1);
      std::string plain(field), marked;
      std::erase(plain, layout.decimal);
      if (field.front() == '0' || plain.find_first_not_of("0123456789") != std::string::npos) return {};
      marked = with_thousands(plain);
      std::ranges::replace(marked, ',', layout.decimal);
      if (marked != field) return {};
      example = field;
    }
  }
  if (example.empty()) return {};
  const std::string mark = layout.decimal == ',' ? "comma" : "point";
  return Error{"found numbers such as " + example + ", whose " + mark +
               " may be a decimal mark or a thousands mark; add --decimal " + mark +
               ", or export the numbers without thousands marks"};
}

// Determines the fields of a row from the most frequent number of fields, and whether most rows begin with a word.
void measure_rows(Lines lines, TableLayout& layout) {
  struct Width {
    std::size_t rows = 0, last_value = 0, words = 0;
  };
  std::map<std::size_t, Width> widths;
  std::map<std::size_t, std::size_t> filled;
  Fields fields;
  for (const std::string_view line : lines) {
    const LineShape shape = shape_of(line, layout.delimiter, layout.decimal, fields);
    if (!shape.is_row()) continue;
    Width& width = widths[shape.fields];
    ++width.rows;
    ++filled[fields.size()];
    width.last_value = std::max(width.last_value, fields.size());
    width.words += shape.first_is_word;
  }
  const auto& [fields_of_most, most] =
      *std::ranges::max_element(widths, {}, [](const auto& one) { return one.second.rows; });
  layout.fields = fields_of_most;
  layout.columns = layout.widest = most.last_value;
  layout.first_is_word = 2 * most.words > most.rows;
  for (const auto& [width, number] : filled)
    if (number >= kRowsOfAWidth) layout.widest = std::max(layout.widest, width);
}

// "1,2,3": the numbers of the columns. A row with these numbers is followed by one that is as near as the next.
bool numbers_columns(Lines lines, const TableLayout& layout, std::size_t i) {
  Fields first, second, third;
  split_table_fields(lines[i], layout.delimiter, first);
  int number = first.empty() || first.front() != "0" ? 1 : 0;
  if (first.size() < 2 || !std::ranges::all_of(first, [&](auto one) { return one == std::to_string(number++); }))
    return false;
  for (Fields* row : {&second, &third})
    while (++i < lines.size() && !is_row(layout, lines[i], *row)) {
    }
  for (std::size_t k = 0; i < lines.size() && k < std::min({first.size(), second.size(), third.size()}); ++k) {
    double a = 0.0, b = 0.0, c = 0.0;
    if (parse_table_number(first[k], layout.decimal, a) && parse_table_number(second[k], layout.decimal, b) &&
        parse_table_number(third[k], layout.decimal, c) && std::abs(b - a) > 2.0 * std::abs(c - b))
      return true;
  }
  return false;
}

enum class Kind { text, row, other };  // other: numbers that are no row of this table

// Puts every row into a block.
void find_blocks(Lines lines, std::uint64_t most_bad, TableLayout& layout) {
  // Lines of one kind in sequence.
  struct Run {
    Kind kind = Kind::text;
    RowBlock block;
    bool names_columns = false, has_numbers = false;
  };
  std::vector<Run> runs;
  Fields fields;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (trimmed(lines[i]).empty() || lines[i].starts_with('#')) continue;
    const bool row = is_row(layout, lines[i], fields);
    const LineShape shape = shape_of(lines[i], layout.delimiter, layout.decimal, fields);
    const bool begins = runs.empty() || runs.back().kind == Kind::text;
    const bool numbers = shape.is_row() || (shape.numbers > 0 && shape.words == 0);
    Kind kind = Kind::text;
    // A row without any value does not begin a table.
    if (row && (shape.numbers > 0 || !begins))
      kind = begins && numbers_columns(lines, layout, i) ? Kind::other : Kind::row;
    else if (!row && numbers && (layout.first_is_word || !shape.first_is_word))
      kind = Kind::other;
    if (runs.empty() || runs.back().kind != kind) runs.push_back({kind, {i, i, 0, shape.fields}});
    Run& run = runs.back();
    run.block.end = i + 1;
    ++run.block.rows;
    run.has_numbers = run.has_numbers || shape.numbers > 0;
    run.names_columns = run.names_columns || (kind == Kind::text && named_roles(fields).count >= kNamedRoles);
  }
  // Text between rows ends a block; a few lines of it, and a few rows of another length, belong to the table.
  bool in_table = false;
  const Run* text = nullptr;
  for (const Run& run : runs) {
    const Run* before = std::exchange(text, run.kind == Kind::text && !layout.blocks.empty() ? &run : nullptr);
    if (run.kind == Kind::text) continue;
    const bool row = run.kind == Kind::row;
    bool joins = in_table && (row || (before == nullptr && run.block.rows < kOtherRows));
    if (before != nullptr) {
      joins = joins && !before->names_columns && before->block.rows <= most_bad;
      layout.skippable = layout.skippable && !before->names_columns && !before->has_numbers;
      if (joins) most_bad -= before->block.rows;
    }
    if (joins) {
      layout.blocks.back().end = run.block.end;
      if (row) layout.blocks.back().rows += run.block.rows;
    } else {
      layout.blocks.push_back(run.block);
      if (row) layout.blocks.back().fields = layout.fields;
      layout.skippable = layout.skippable && row;
      in_table = row;
    }
  }
}

// Splits a line of names: by the separator of the table; at wide gaps, or before words without units in brackets, where
// that is blanks; as one of R, whose row numbers have no name; or by any other separator (`own` false). The fields are
// those of the first of these that gives a name for each column; without one those of the separator.
bool split_names(std::string_view line, std::string_view first_row, const TableLayout& layout, Fields& names,
                 bool& own) {
  std::string_view bare = trimmed(line);
  const std::size_t begin = bare.find_first_not_of("#%/");
  // "%time" is a name of ROS, and a lone mark is a name of a column of row numbers.
  if (begin < bare.size() && (begin != 1 || bare.front() != '%' || bare.find_first_of(" \t") <= 5))
    bare = trimmed(bare.substr(begin));
  const bool blanks = layout.delimiter.is_blanks();
  own = true;
  std::vector<Fields> ways;
  for (const std::string_view text : {line, bare}) {
    Fields words, wide, joined_words;
    split_table_fields(text, layout.delimiter, words);
    ways.push_back(words);
    if (!blanks) continue;
    for (std::string_view rest = text; !(rest = trimmed(rest)).empty();) {
      const std::size_t end = std::min({rest.find("  "), rest.find('\t'), rest.size()});
      wide.push_back(trimmed(rest.substr(0, end)));
      rest.remove_prefix(end);
    }
    for (const std::string_view word : words) {
      if (joined_words.empty() || (!word.starts_with('[') && !word.starts_with('(')))
        joined_words.push_back(word);
      else
        joined_words.back() = {joined_words.back().data(), word.data() + word.size()};
    }
    ways.push_back(wide);
    ways.push_back(joined_words);
  }
  for (const Fields& way : ways)
    if (blanks ? way.size() == layout.columns : way.size() >= layout.columns) return names = way, true;
  Fields row;
  split_table_fields(first_row, layout.delimiter, row);
  if (!row.empty() && row.front() == "1" && ways.front().size() + 1 == layout.columns) {
    names = ways.front();
    names.insert(names.begin(), std::string_view());
    return true;
  }
  for (const Delimiter& other : kDelimiters) {
    if (!blanks && ways.front().size() > 1) break;  // the line has the separator of the table
    split_table_fields(bare, other, names);
    if (names.size() == layout.columns) return own = false, true;
  }
  split_table_fields(bare, layout.delimiter, names);
  return false;
}

bool is_names_row(const Fields& fields) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c & 0x80) != 0; };
  double value = 0.0;
  return std::ranges::count_if(fields, [&](std::string_view field) {
           return std::ranges::any_of(field, is_letter) && !parse_table_number(field, '.', value);
         }) >= 2;
}

// Whether most fields of a line are units, at least one of them of time, length or force; `few`: or two of these.
bool is_units_row(const Fields& fields, bool few) {
  std::size_t known = 0, others = 0, words = 0;
  for (const std::string_view field : fields) {
    if (field.empty() || field == "-" || field == "[]" || field == "[-]") continue;
    const bool bracketed = field.size() > 2 && (field.front() == '[' || field.front() == '(');
    ++(find_unit(field) ? known : bracketed || is_other_unit(field) ? others : words);
  }
  return (known > 0 && known + others >= 2 && known + others > words) || (few && known >= 2);
}

// Text files of LabVIEW have the units of the columns above the table and, if the table has no times, the interval and
// the first time of each channel.
void read_labview_head(Lines lines, std::size_t first, TableLayout& layout) {
  Fields fields;
  bool times = true;
  const auto numbers = [&] {
    std::vector<double> values(fields.size(), 0.0);
    for (std::size_t i = 1; i < fields.size(); ++i) parse_table_number(fields[i], layout.decimal, values[i]);
    return values;
  };
  for (std::size_t i = 0; i < first; ++i) {
    if (lines[i].find_first_of("YXD") != 0) continue;
    split_table_fields(lines[i], layout.delimiter, fields);
    if (fields.size() < 2) continue;
    if (fields[0] == "Y_Unit_Label") layout.units = fields;
    if (fields[0] == "Y_Unit_Label") layout.units[0] = {};
    if (fields[0] == "X_Columns") times = fields[1] != "No";
    if (fields[0] == "Delta_X") layout.steps_s = numbers();
    if (fields[0] == "X0") layout.starts_s = numbers();
  }
  if (times) layout.steps_s.clear();
}

}  // namespace

bool is_row(const TableLayout& layout, std::string_view line, Fields& fields) {
  const LineShape shape = shape_of(line, layout.delimiter, layout.decimal, fields);
  if (shape.numbers == 0) return shape.fields == layout.fields && shape.missing >= 2 && shape.words == 0;
  if (shape.numbers + shape.missing == shape.clocks || (!layout.first_is_word && shape.first_is_word)) return false;
  // More fields than the others are remarks, but not numbers.
  return shape.last_number <= layout.widest &&
         (shape.fields == layout.fields || (shape.fields > layout.fields && shape.is_row()));
}

Result<TableLayout> find_table_layout(Lines lines, std::optional<char> given_decimal, std::uint64_t most_bad) {
  TableLayout layout;
  std::pair<bool, std::size_t> best;
  for (const Delimiter& delimiter : kDelimiters) {
    if (delimiter.is_blanks() && best.first && best.second > 0) break;  // they also separate a date from a time
    for (const char decimal : {'.', ','}) {
      if (given_decimal && *given_decimal != decimal) continue;
      const auto fit = fit_of(lines, delimiter, decimal);
      if (fit.second == 0 || !(fit > best)) continue;
      best = fit;
      layout.delimiter = delimiter;
      layout.decimal = decimal;
    }
  }
  const std::size_t tried = std::min(lines.size(), kSampleLines);
  const Error none{"found no rows of numbers in the first " + std::to_string(tried) +
                   (tried == 1 ? " line" : " lines") + ", such as \"" +
                   (lines.empty() ? "" : printable(lines[tried / 2])) +
                   "\", expected a table with columns of time, position and force; export the recording as CSV"};
  if (best.second == 0) return none;
  measure_rows(lines, layout);
  find_blocks(lines, most_bad, layout);
  if (layout.blocks.empty()) return none;
  if (!given_decimal)
    if (const Status status = check_decimal_mark(lines, layout); !status) return status.error();
  return layout;
}

void find_table_header(Lines lines, std::size_t first, TableLayout& layout) {
  // The nearest line of each kind: with names of at least two roles; the same, but without one of each column; with
  // any words; of units alone.
  constexpr std::size_t named = 0, misfit = 1, words = 2, units = 3, kinds = 4;
  std::array<Fields, kinds> fields;
  std::array<std::size_t, kinds> line{};  // from 1
  std::size_t seen = 0;
  Fields row;
  for (std::size_t i = first; i-- > 0 && seen < kReach;) {
    if (trimmed(lines[i]).empty()) continue;
    if (lines[i].starts_with("***")) break;  // the end of LabVIEW's head, which names units and the axis
    if (is_row(layout, lines[i], row)) {
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
    const bool below = line[named] == 0, names_row = is_names_row(names), two_roles = roles.count >= kNamedRoles;
    const std::size_t kind = fits && is_units_row(names, roles.count == 0 && below) ? units
                             : names_row && two_roles                               ? (fits ? named : misfit)
                             : names_row && fits && own                             ? words
                                                                                    : kinds;
    if (kind == named && line[named] > 0 && names != fields[named]) layout.rival = i + 1;
    if (kind == kinds || line[kind] > 0) continue;
    line[kind] = i + 1;
    fields[kind] = std::move(names);
  }
  const auto header =
      static_cast<std::size_t>(std::ranges::find_if(line, [](auto one) { return one > 0; }) - line.begin());
  if (header < kinds) {
    layout.header = line[header];
    layout.names = fields[header];
    layout.misfit = header == misfit;
    if (layout.misfit) return;
    layout.columns = std::clamp(layout.names.size(), layout.columns, layout.widest);
    layout.names.resize(layout.columns);
    if (line[units] >= layout.header) layout.units = fields[units];
  }
  read_labview_head(lines, first, layout);
}

}  // namespace palpate
