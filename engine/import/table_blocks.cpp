// The separator and the decimal mark of a table, and its blocks of rows.
#include <algorithm>
#include <map>

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

// Whether a field begins like a number and is none, which indicates a wrong reading.
bool is_mangled(std::string_view field) {
  return field.find_first_of("0123456789") < 2 &&
         field.find_first_not_of("0123456789.,;+-eE \t") == std::string_view::npos;
}

struct FieldCount {
  std::size_t numbers = 0, clocks = 0, missing = 0, words = 0;  // the clocks are numbers, too
  bool is_row() const { return numbers > 0 && numbers + missing >= 2 && numbers + missing >= words; }
  // Numbers alone, though not as many as in a row.
  bool is_number() const { return numbers > 0 && words == 0; }
};

FieldCount count_fields(const Fields& fields, char decimal) {
  FieldCount count;
  for (const std::string_view field : fields) {
    if (field.empty()) continue;
    const bool number = parse_table_cell(field, decimal).has_value(), clock = !number && is_of_a_clock(field);
    if (clock) ++count.clocks;
    ++(number || clock ? count.numbers : is_missing_value(field) ? count.missing : count.words);
  }
  return count;
}

// One combination of separator and decimal mark.
struct Marks {
  Delimiter delimiter;
  char decimal = '.';
  std::size_t numbers = 0, mangled = 0;  // in the rows

  bool better_than(const Marks& other) const {
    if ((mangled == 0) != (other.mangled == 0)) return mangled == 0;
    return numbers > other.numbers;
  }
};

// Counts the longest run of rows.
Marks read_as(const std::vector<std::string_view>& lines, const Delimiter& delimiter, char decimal) {
  Marks best{delimiter, decimal}, run = best;
  Fields fields;
  for (std::size_t i = 0; i < std::min(lines.size(), kSampleLines); ++i) {
    if (trimmed(lines[i]).empty()) continue;
    split_table_fields(lines[i], delimiter, fields);
    const FieldCount count = count_fields(fields, decimal);
    if (!count.is_row()) {
      run = {delimiter, decimal};
      continue;
    }
    run.numbers += count.numbers + count.missing;
    run.mangled += static_cast<std::size_t>(std::ranges::count_if(fields, [&](std::string_view field) {
      return is_mangled(field) && !parse_table_cell(field, decimal) && !is_of_a_clock(field) &&
             !is_missing_value(field);
    }));
    if (run.numbers > best.numbers) best = run;
  }
  return best;
}

// Refuses numbers whose comma may be a thousands mark in every cell: "1,234", but not "0,123" or "1,5".
Status check_decimal_comma(const std::vector<std::string_view>& lines, const TableLayout& layout) {
  Fields fields;
  std::string example;
  for (const std::string_view line : lines) {
    if (!is_row(layout, line, fields)) continue;
    for (std::string_view field : fields) {
      double value = 0.0;
      if (field.find(',') == std::string_view::npos || !parse_table_number(field, ',', value)) continue;
      if (field.front() == '-' || field.front() == '+') field.remove_prefix(1);
      std::string plain(field);
      std::erase(plain, ',');
      if (field.front() == '0' || with_thousands(plain) != field) return {};
      example = field;
    }
  }
  if (example.empty()) return {};
  return Error{"found numbers such as " + example +
               ", whose comma may be a decimal mark or a thousands mark; add --decimal comma, or export the "
               "numbers without thousands marks"};
}

// Determines the fields of a row: the most frequent number of fields, and how many of them have values.
void measure_rows(const std::vector<std::string_view>& lines, TableLayout& layout) {
  std::map<std::size_t, std::size_t> counts, filled, last_value;
  Fields fields;
  for (const std::string_view line : lines) {
    if (trimmed(line).empty()) continue;
    const std::size_t count = split_table_fields(line, layout.delimiter, fields);
    if (!count_fields(fields, layout.decimal).is_row()) continue;
    ++counts[count];
    ++filled[fields.size()];
    last_value[count] = std::max(last_value[count], fields.size());
  }
  layout.fields = std::ranges::max_element(counts, {}, [](const auto& one) { return one.second; })->first;
  layout.columns = layout.widest = last_value[layout.fields];
  for (const auto& [width, number] : filled)
    if (number >= kRowsOfAWidth) layout.widest = std::max(layout.widest, width);
}

// "1,2,3": the numbers of the columns.
bool numbers_columns(const Fields& fields) {
  int number = fields.empty() || fields.front() != "0" ? 1 : 0;
  return fields.size() >= 2 &&
         std::ranges::all_of(fields, [&](auto field) { return field == std::to_string(number++); });
}

// Whether the row after line `i` has decimals.
bool decimals_follow(const std::vector<std::string_view>& lines, const TableLayout& layout, std::size_t i) {
  Fields fields;
  while (++i < lines.size() && !is_row(layout, lines[i], fields)) {
  }
  return i < lines.size() &&
         std::ranges::any_of(fields, [&](auto field) { return field.find(layout.decimal) != field.npos; });
}

enum class Kind { text, row, other };  // other: numbers that are no row of this table

// Whether most rows begin with a word.
bool begin_with_words(const std::vector<std::string_view>& lines, const TableLayout& layout) {
  std::size_t words = 0, rows = 0;
  Fields fields;
  for (const std::string_view line : lines) {
    if (split_table_fields(line, layout.delimiter, fields) != layout.fields || fields.empty()) continue;
    ++rows;
    words += count_fields({fields.front()}, layout.decimal).words;
  }
  return 2 * words > rows;
}

// Puts every row into a block.
void find_blocks(const std::vector<std::string_view>& lines, std::uint64_t most_bad, TableLayout& layout) {
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
    const std::size_t width = split_table_fields(lines[i], layout.delimiter, fields);
    const FieldCount count = count_fields(fields, layout.decimal);
    const bool begins = runs.empty() || runs.back().kind == Kind::text;
    const bool word = !fields.empty() && count_fields({fields.front()}, layout.decimal).words > 0;
    Kind kind = Kind::text;
    // A row without any value does not begin a table, and one of the numbers of the columns (1, 2, 3) is no row.
    if (row && (count.numbers > 0 || !begins))
      kind = begins && numbers_columns(fields) && decimals_follow(lines, layout, i) ? Kind::other : Kind::row;
    if (!row && (layout.first_is_word || !word) && (count.is_row() || count.is_number())) kind = Kind::other;
    if (runs.empty() || runs.back().kind != kind) runs.push_back({kind, {i, i, 0, width}});
    Run& run = runs.back();
    run.block.end = i + 1;
    ++run.block.rows;
    run.has_numbers = run.has_numbers || count.numbers > 0;
    run.names_columns = run.names_columns || (kind == Kind::text && named_roles(fields).count >= 2);
  }
  // Text between rows ends a block; a few lines of it, and a few rows of another length, belong to the table.
  bool in_table = false;
  const Run* text = nullptr;
  for (const Run& run : runs) {
    if (run.kind == Kind::text) {
      text = layout.blocks.empty() ? nullptr : &run;
      continue;
    }
    const bool row = run.kind == Kind::row;
    bool joins = in_table && (row || (text == nullptr && run.block.rows < kOtherRows));
    if (text != nullptr) {
      joins = joins && !text->names_columns && text->block.rows <= most_bad;
      layout.skippable = layout.skippable && !text->names_columns && !text->has_numbers;
      if (joins) most_bad -= text->block.rows;
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
    text = nullptr;
  }
}

}  // namespace

bool is_row(const TableLayout& layout, std::string_view line, Fields& fields) {
  const std::size_t count = split_table_fields(line, layout.delimiter, fields);
  const FieldCount numbers = count_fields(fields, layout.decimal);
  if (numbers.numbers == 0) return count == layout.fields && numbers.missing >= 2 && numbers.words == 0;
  if (numbers.numbers + numbers.missing == numbers.clocks) return false;
  if (!layout.first_is_word && !fields.empty() && count_fields({fields.front()}, layout.decimal).words > 0)
    return false;
  if (count < layout.fields) return false;
  // More fields than the others: remarks, but not numbers.
  const Fields beyond(fields.begin() + static_cast<std::ptrdiff_t>(std::min(fields.size(), layout.widest)),
                      fields.end());
  return count_fields(beyond, layout.decimal).numbers == 0 && (count == layout.fields || numbers.is_row());
}

Result<TableLayout> find_table_layout(const std::vector<std::string_view>& lines, std::optional<char> given_decimal,
                                      std::uint64_t most_bad) {
  Marks best;
  for (const Delimiter& delimiter : kDelimiters) {
    for (const char decimal : {'.', ','}) {
      if (given_decimal && *given_decimal != decimal) continue;
      const Marks marks = read_as(lines, delimiter, decimal);
      if (marks.numbers > 0 && (best.numbers == 0 || marks.better_than(best))) best = marks;
    }
  }
  if (best.numbers == 0) {
    const std::size_t tried = std::min(lines.size(), kSampleLines);
    return Error{"found no rows of numbers in the first " + std::to_string(tried) + (tried == 1 ? " line" : " lines") +
                 ", expected a table with columns of time, position and force; export the recording as CSV"};
  }
  TableLayout layout{best.delimiter, best.decimal};
  measure_rows(lines, layout);
  layout.first_is_word = begin_with_words(lines, layout);
  find_blocks(lines, most_bad, layout);
  if (layout.decimal == ',' && !given_decimal)
    if (const Status status = check_decimal_comma(lines, layout); !status) return status.error();
  return layout;
}

}  // namespace palpate
