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
    if (!count.is_row() || count.numbers + count.missing < 2) {
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

// Whether a comma in the numbers can only be a decimal mark: not followed by exactly three digits, or after a single 0
// or more than three digits.
bool proves_decimal_comma(std::string_view field) {
  const std::size_t comma = field.find(',');
  if (comma == std::string_view::npos) return false;
  std::string_view whole = field.substr(0, comma);
  if (!whole.empty() && (whole.front() == '-' || whole.front() == '+')) whole.remove_prefix(1);
  const std::size_t end = std::min(field.find_first_not_of("0123456789", comma + 1), field.size());
  return end - comma - 1 != 3 || whole.empty() || whole.front() == '0' || whole.size() > 3;
}

Status check_decimal_comma(const std::vector<std::string_view>& lines, const TableLayout& layout) {
  Fields fields;
  std::string_view example;
  for (const std::string_view line : lines) {
    if (!is_row(layout, line, fields)) continue;
    for (const std::string_view field : fields) {
      double value = 0.0;
      if (field.find(',') == std::string_view::npos || !parse_table_number(field, ',', value)) continue;
      if (proves_decimal_comma(field)) return {};
      example = field;
    }
  }
  if (example.empty()) return {};
  return Error{"found numbers such as " + std::string(example) +
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

enum class Kind { blank, text, row, other };  // other: numbers that are no row of this table

class BlockFinder {
 public:
  BlockFinder(const std::vector<std::string_view>& lines, TableLayout& layout, std::uint64_t most_bad)
      : lines_(lines), layout_(layout), left_(most_bad) {}

  void run() {
    find_first_words();
    std::size_t text = 0, others = 0, first_other = 0;  // lines since the last row
    bool names = false;                                 // the text names columns
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const Kind kind = kind_of(lines_[i]);
      if (kind == Kind::blank) continue;
      if (kind == Kind::text) {
        ++text;
        names = names || named_roles(fields_).count >= 2;
        if (open_ && count_fields(fields_, layout_.decimal).numbers > 0) layout_.skippable = false;
        continue;
      }
      const bool in_table = open_ && block_.fields == layout_.fields;
      if (open_ && text > 0) {
        // Text between rows ends a block; a few lines of it may be left out.
        if (names) layout_.skippable = false;
        const bool joins = kind == Kind::row && in_table && !names && text <= left_;
        if (joins)
          left_ -= text;
        else
          close();
      }
      text = 0;
      names = false;
      if (kind == Kind::row) {
        others = 0;
        if (open_ && !in_table) close();
      } else if (open_ && in_table) {
        if (others++ == 0) first_other = i;
        block_.end = i + 1;
        if (others < kOtherRows) continue;
        block_.end = first_other;
        close();
        block_ = {first_other, i + 1, others - 1, fields_now_};
        open_ = true;
      }
      if (!open_) block_ = {i, i, 0, kind == Kind::row ? layout_.fields : fields_now_};
      open_ = true;
      block_.end = i + 1;
      ++block_.rows;
    }
    close();
    split_off_numbers_of_columns();
    layout_.skippable = layout_.skippable && std::ranges::all_of(layout_.blocks, [&](const RowBlock& block) {
                          return block.fields == layout_.fields;
                        });
  }

 private:
  Kind kind_of(std::string_view line) {
    if (trimmed(line).empty() || line.starts_with('#')) return Kind::blank;
    fields_now_ = split_table_fields(line, layout_.delimiter, fields_);
    const FieldCount count = count_fields(fields_, layout_.decimal);
    // A row without any value does not begin a table.
    if (is_row(layout_, line, fields_)) return count.numbers > 0 || open_ ? Kind::row : Kind::text;
    if (!layout_.first_is_word && !fields_.empty() && is_word(fields_.front())) return Kind::text;  // "Samples;1200"
    return count.is_row() || count.is_number() ? Kind::other : Kind::text;
  }
  bool is_word(std::string_view field) const {
    return !field.empty() && !parse_table_cell(field, layout_.decimal) && !is_of_a_clock(field) &&
           !is_missing_value(field);
  }
  // Whether most rows begin with a word.
  void find_first_words() {
    std::size_t words = 0, rows = 0;
    for (const std::string_view line : lines_) {
      if (split_table_fields(line, layout_.delimiter, fields_) != layout_.fields || fields_.empty()) continue;
      ++rows;
      if (is_word(fields_.front())) ++words;
    }
    layout_.first_is_word = 2 * words > rows;
  }
  void close() {
    if (open_) layout_.blocks.push_back(block_);
    open_ = false;
  }
  // A row of the numbers of the columns (1, 2, 3) before rows with decimals.
  void split_off_numbers_of_columns() {
    Fields next;
    for (std::size_t b = 0; b < layout_.blocks.size(); ++b) {
      RowBlock& block = layout_.blocks[b];
      if (block.rows < 3 || block.fields != layout_.fields) continue;
      split_table_fields(lines_[block.begin], layout_.delimiter, fields_);
      std::size_t second = block.begin + 1;
      while (!is_row(layout_, lines_[second], next)) ++second;
      int expected = fields_.empty() || fields_.front() != "0" ? 1 : 0;
      const bool numbered = fields_.size() >= 2 && std::ranges::all_of(fields_, [&](std::string_view field) {
                              return field == std::to_string(expected++);
                            });
      const bool decimals = std::ranges::any_of(
          next, [&](std::string_view field) { return field.find(layout_.decimal) != std::string_view::npos; });
      if (!numbered || !decimals) continue;
      const RowBlock number{block.begin, block.begin + 1, 1, block.fields};
      block.begin = second;
      --block.rows;
      layout_.blocks.insert(layout_.blocks.begin() + static_cast<std::ptrdiff_t>(b), number);
      layout_.skippable = false;
      return;
    }
  }

  const std::vector<std::string_view>& lines_;
  TableLayout& layout_;
  std::uint64_t left_;
  Fields fields_;
  std::size_t fields_now_ = 0;
  bool open_ = false;
  RowBlock block_;
};

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
  BlockFinder(lines, layout, most_bad).run();
  if (layout.decimal == ',' && !given_decimal)
    if (const Status status = check_decimal_comma(lines, layout); !status) return status.error();
  return layout;
}

}  // namespace palpate
