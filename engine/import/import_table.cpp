#include "engine/import/import_table.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <utility>

#include "engine/base/statistics.h"
#include "engine/base/text.h"
#include "engine/import/table_parts.h"

namespace palpate {
namespace {

// Fewer rows do not show that a column counts them.
constexpr std::size_t kCountedRows = 10;
// A longer list of readings is cut.
constexpr std::size_t kMostReadings = 12;
// A time that goes back by more steps begins another recording.
constexpr double kSwappedSteps = 3.0;
// Rows alternate between series where those that are so many apart differ by so much less than neighbours. In one
// series the ratio is 1 for independent noise and less for a smooth motion; only a periodic disturbance may exceed it.
constexpr std::size_t kMostSeries = 8;
constexpr double kSeriesDifference = 3.0;
// With more unreadable rows than one in so many, or more cells that have digits and are no numbers, leaving rows out is
// no reading of the table.
constexpr std::uint64_t kMostBad = 4;
constexpr std::uint64_t kOtherForms = 2;
// Two channels are not resampled where the interpolation of the slower one errs by more than this share of its range.
constexpr double kInterpolationShare = 0.01;
// Steps of the time are equal within this share; more steps of twice the length than this share are no single lost
// rows.
constexpr double kEqualSteps = 0.05, kDoubledSteps = 0.02;
// The difference of two durations of one recording.
constexpr double kDurationShare = 0.05, kDuration_s = 2.0;

std::string short_number(double value) { return general(value, 6); }

// "3 rows"
std::string count_of(std::uint64_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string lines_words(const LineRange& lines) {
  return lines.first == lines.last ? "line " + std::to_string(lines.first)
                                   : "lines " + std::to_string(lines.first) + " to " + std::to_string(lines.last);
}

// An error with the readings that remain, each as a command; one without an option is none.
Error refusal(const std::string& path, const ImportRequest& request, const std::string& text,
              const std::vector<Reading>& readings = {}) {
  std::string message = path + text;
  const std::string command =
      request.command.empty() ? "palpate import " + shell_word(path) + " --out REC.csv" : request.command;
  for (std::size_t i = 0; i < std::min(readings.size(), kMostReadings); ++i) {
    const auto& [option, meaning] = readings[i];
    message += "\n  " + (option.empty() ? meaning : command + " " + option + "  # " + meaning);
  }
  if (readings.size() > kMostReadings)
    message += "\n  and " + std::to_string(readings.size() - kMostReadings) + " more";
  return Error{message};
}

// A reading of a part of the rows, if they are enough for a recording.
Reading part_reading(const std::string& option, std::size_t rows, const std::string& meaning) {
  const bool enough = rows >= kRecordingMinimumRows;
  return {enough ? option : "", meaning + (enough ? "" : ", too few for a recording")};
}

class Importer {
 public:
  Importer(ForeignText foreign, const std::string& path, const ImportRequest& request)
      : path_(path), request_(request), text_(std::move(foreign.text)), lines_(lines_of(text_)) {
    table_.encoding = foreign.encoding;
  }

  Result<ImportedTable> run() {
    using Step = Status (Importer::*)();
    for (const Step step :
         {&Importer::find_rows, &Importer::check_header, &Importer::choose_roles, &Importer::refuse_series,
          &Importer::find_units, &Importer::read_rows, &Importer::check_times, &Importer::set_times, &Importer::finish})
      if (Status status = (this->*step)(); !status) return status.error();
    return std::move(table_);
  }

 private:
  // A line that is a row in time. Without a clock it may be text, which keeps its place.
  struct Slot {
    std::uint32_t line = 0;  // from 1
    bool is_row = true, good = true;
  };

  Error fail(const std::string& text, const std::vector<Reading>& readings = {}) const {
    return refusal(path_, request_, ": " + text, readings);
  }
  Error fail_at(std::size_t line, const std::string& text, const std::vector<Reading>& readings = {}) const {
    return refusal(path_, request_, ":" + std::to_string(line) + ": " + text, readings);
  }
  void note(const std::string& sentence) { table_.notes.push_back(sentence); }
  void leave_out(const char* reason, std::uint64_t line, std::uint64_t rows = 1) {
    auto& list = table_.left_out;
    const auto found = std::ranges::find(list, reason, &LeftOut::reason);
    if (found == list.end()) return list.push_back({reason, rows, {line, line}});
    found->rows += rows;
    found->lines.last = std::max(found->lines.last, line);
  }
  static bool is_empty(std::string_view cell) { return cell.empty() || is_missing_value(cell); }
  // ' "Weg [mm]"' for a message; empty without a header.
  std::string quoted_name(std::size_t number) const {
    return layout_.names.empty() ? "" : " \"" + printable(columns_[number - 1].header) + "\"";
  }
  // 'column 2 "Weg [mm]"'
  std::string column_name(std::size_t number) const { return "column " + std::to_string(number) + quoted_name(number); }
  // 'the position "Weg [mm]"'
  std::string the_role(std::size_t role) const {
    return "the " + std::string(kRoleNames[role]) + quoted_name(number_[role]);
  }
  // The numbers, dates and times of day in a line, however they are separated, and not as a part of a word.
  static std::ptrdiff_t numbers_in(std::string_view line) {
    std::ptrdiff_t numbers = 0;
    for (std::size_t at = 0; (at = line.find_first_of("0123456789", at)) != std::string_view::npos;) {
      const char before = at > 0 ? line[at - 1] : ' ';
      if (before != '_' && std::isalpha(static_cast<unsigned char>(before)) == 0) ++numbers;
      at = std::min(line.find_first_not_of("0123456789.:+-/eE'", at), line.size());
    }
    return numbers;
  }
  static std::string rows_option(const LineRange& part) {
    return "--rows " + std::to_string(part.first) + "-" + std::to_string(part.last);
  }
  // The lines of each part of the table: a new one begins where `differs(last slot, slot)`.
  template <typename Differs, typename Counts, typename Meaning>
  std::vector<Reading> parts_of(const Differs& differs, const Counts& counts, const Meaning& meaning) const {
    std::vector<Reading> parts;
    std::size_t first = 0, last = 0, rows = 0;
    const auto end = [&] {
      const LineRange lines{slots_[first].line, slots_[last].line};
      parts.push_back(
          part_reading(rows_option(lines), rows, rows < kRecordingMinimumRows ? lines_words(lines) : meaning(last)));
      rows = 0;
    };
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      if (!counts(i)) continue;
      if (rows > 0 && differs(last, i)) end();
      if (rows++ == 0) first = i;
      last = i;
    }
    end();
    return parts;
  }
  // The cells of a column in every slot.
  Fields cells_of(std::size_t number) const {
    Fields cells, fields;
    cells.reserve(slots_.size());
    for (const Slot& slot : slots_) {
      if (slot.is_row) split_table_fields(lines_[slot.line - 1], layout_.delimiter, fields);
      cells.push_back(slot.is_row && number > 0 && number <= fields.size() ? fields[number - 1] : std::string_view());
    }
    return cells;
  }
  // The plain numbers of a column; NaN where there is none. Without a column empty.
  std::vector<double> numbers_of(std::size_t number) const {
    const Fields cells = number > 0 ? cells_of(number) : Fields();
    std::vector<double> numbers(cells.size(), std::nan(""));
    for (std::size_t i = 0; i < cells.size(); ++i) {
      double value = 0.0;
      if (parse_table_number(cells[i], layout_.decimal, value)) numbers[i] = value;
    }
    return numbers;
  }

  // Finds the block of rows that is the table.
  Status find_rows() {
    std::size_t before = 0, after = lines_.size();
    if (request_.rows) {
      before = std::min<std::size_t>(request_.rows->first - 1, lines_.size());
      after = std::max(before, std::min<std::size_t>(request_.rows->last, lines_.size()));
    }
    const auto begin = lines_.begin();
    auto layout =
        find_table_layout({begin + static_cast<std::ptrdiff_t>(before), begin + static_cast<std::ptrdiff_t>(after)},
                          request_.decimal, request_.skip_bad_rows);
    if (!layout) return fail(layout.error().message);
    layout_ = std::move(*layout);
    std::vector<Reading> readings;
    std::size_t between = 0, end = 0;
    for (RowBlock& block : layout_.blocks) {
      block.begin += before;
      block.end += before;
      if (!readings.empty())
        for (std::size_t i = block.begin; !trimmed(lines_[i - 1]).empty() && i > end; --i) ++between;
      end = block.end;
      readings.push_back(part_reading("--block " + std::to_string(readings.size() + 1), block.rows,
                                      lines_words({block.begin + 1, block.end}) + ": " + count_of(block.rows, "row") +
                                          " of " + count_of(block.fields, "field")));
    }
    const std::size_t chosen = request_.rows ? 0 : request_.block;
    if (chosen > readings.size())
      return fail("found " + count_of(readings.size(), "block") + " of rows, expected at least " +
                  std::to_string(chosen));
    if (chosen == 0 && readings.size() > 1) {
      if (layout_.skippable)
        readings.insert(readings.begin(), {"--skip-bad-rows " + std::to_string(request_.skip_bad_rows + between),
                                           "all rows, without the text between them"});
      return fail("found numbers in " + count_of(layout_.blocks.size(), "block") +
                      ", expected one table that explains every row; choose the rows",
                  readings);
    }
    block_ = layout_.blocks[std::max<std::size_t>(chosen, 1) - 1];
    for (const RowBlock& other : layout_.blocks) {
      if (other.begin == block_.begin) continue;
      leave_out("in another block", other.begin + 1, other.rows);
      leave_out("in another block", other.end, 0);
    }
    Fields fields;
    for (std::size_t i = 0; request_.rows && i < lines_.size(); ++i)
      if ((i < before || i >= after) && is_row(layout_, lines_[i], fields)) leave_out("outside --rows", i + 1);
    find_table_header(lines_, block_.begin, layout_);
    return {};
  }

  // Refuses lines below the header, or after the table, that have as many numbers as a row and are none; and a header
  // that does not determine the columns, unless the user gives their numbers.
  Status check_header() {
    Fields fields;
    const auto cells_with = [&](std::size_t line, const auto& test) {
      split_table_fields(lines_[line], layout_.delimiter, fields);
      return std::ranges::count_if(fields, test);
    };
    const auto numbers = cells_with(block_.begin, [](std::string_view field) { return numbers_in(field) > 0; });
    const auto is_number = [&](std::string_view field) { return parse_table_cell(field, layout_.decimal).has_value(); };
    std::size_t line = layout_.header > 0 || block_.begin == 0 ? layout_.header : block_.begin - 1;
    for (; line < lines_.size() && !request_.rows && request_.block == 0; ++line) {
      if (line == block_.begin) line = block_.end;
      if (line == lines_.size()) break;
      if (numbers_in(lines_[line]) >= numbers || cells_with(line, is_number) >= 2)
        return fail_at(
            line + 1,
            "found \"" + printable(lines_[line]) +
                "\", which has the numbers of a row and is none of the table; correct the line, or leave it out",
            {{rows_option({block_.begin + 1, block_.end}), "without such lines"}});
    }
    if (!layout_.misfit && layout_.rival == 0) return {};
    std::vector<std::string> names;
    for (const std::string_view name : layout_.names) names.push_back('"' + printable(name) + '"');
    const auto [upper, lower] = std::minmax(layout_.header, layout_.rival);
    const bool rival = layout_.rival > 0;
    const std::string found = rival ? "names of columns in this line and in line " + std::to_string(lower)
                                    : std::to_string(names.size()) + " names (" + joined(names) +
                                          "), but the rows from line " + std::to_string(block_.begin + 1) + " have " +
                                          count_of(layout_.columns, "field");
    for (std::size_t role = request_.rate_Hz ? 1 : 0; role < kRoles; ++role)
      if (request_.columns[role].empty() || request_.columns[role].find_first_not_of("0123456789") != std::string::npos)
        return fail_at(rival ? upper : layout_.header,
                       "found " + found +
                           ", expected one header with a name for each field; correct it, or say which "
                           "column is which by their numbers: --columns " +
                           (request_.rate_Hz ? "" : "time=N,") + "position=N,force=N");
    note("warning: the header in line " + std::to_string(layout_.header) + " is not used: it has " + found);
    layout_.names.clear();
    layout_.header = 0;
    return {};
  }

  // Lists the rows of the block. Without a clock every line is a row in time, also an empty one, unless each row has an
  // empty line after it, and a row that was made a comment.
  void list_rows() {
    no_clock_ = request_.rate_Hz || !layout_.steps_s.empty();
    const auto empty = std::count_if(lines_.begin() + static_cast<std::ptrdiff_t>(block_.begin),
                                     lines_.begin() + static_cast<std::ptrdiff_t>(block_.end),
                                     [](std::string_view line) { return trimmed(line).empty(); });
    const bool empty_counts = no_clock_ && static_cast<std::size_t>(empty) + 1 < block_.rows;
    Fields fields;
    slots_.reserve(block_.end - block_.begin);
    for (std::size_t i = block_.begin; i < block_.end; ++i) {
      const std::string_view line = lines_[i];
      if (trimmed(line).empty() && !empty_counts) continue;
      if (line.starts_with('#') && !is_row(layout_, line.substr(1), fields)) {
        leave_out("comments", i + 1);
        continue;
      }
      const bool row = !line.starts_with('#') && is_row(layout_, line, fields);
      if (!row) leave_out("text between the rows", i + 1);
      if (!row && texts_++ == 0) first_text_ = i + 1;
      if (row || no_clock_) slots_.push_back({static_cast<std::uint32_t>(i + 1), row});
    }
    for (std::size_t i = block_.end; i < lines_.size() && !is_row(layout_, lines_[i], fields); ++i)
      if (!trimmed(lines_[i]).empty() && layout_.blocks.size() == 1) leave_out("text after the table", i + 1);
  }

  // Describes each column from all its rows.
  void measure_columns() {
    columns_.resize(layout_.columns);
    Fields above(columns_.size()), fields;
    for (const Slot& slot : slots_) {
      if (!slot.is_row) continue;
      split_table_fields(lines_[slot.line - 1], layout_.delimiter, fields);
      for (std::size_t i = 0; i < std::min(columns_.size(), fields.size()); ++i) {
        ForeignColumn& column = columns_[i];
        const std::string_view cell = fields[i];
        if (&slot == &slots_.front()) column.header = cell;
        if (is_empty(cell) || cell == above[i]) continue;
        if (!above[i].empty()) ++column.changes;
        above[i] = cell;
        if (column.values.size() < kMostValues && std::ranges::find(column.values, cell) == column.values.end())
          column.values.emplace_back(cell);
        column.is_units = column.is_units && find_unit(cell);
        column.is_clock = column.is_clock && is_of_a_clock(cell);
        column.is_whole = column.is_whole && cell.find_first_not_of("-+0123456789") == std::string_view::npos;
      }
    }
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      ForeignColumn& column = columns_[i];
      column.constant = column.changes == 0;
      if (column.values.empty()) column.is_units = column.is_clock = column.is_whole = false;
      if (layout_.names.empty()) continue;
      column.header = layout_.names[i];
      column.parts = header_parts(column.header);
      if (i >= layout_.units.size()) continue;
      const std::string_view text = layout_.units[i];
      const auto unit = find_unit(text), stated = column.parts.unit;
      if (unit && stated && unit->to_si != stated->to_si) column.parts.contradicting = unit->name;
      if (unit && !stated) column.parts.unit = unit;
      if (!unit && !stated && text.find_first_not_of("-[]() ") != std::string_view::npos)
        column.parts.foreign_unit = text;
    }
  }

  // A column that counts the parts of the seconds of the column before it; 0: none.
  std::size_t find_fractions() const {
    for (std::size_t i = 1; i < columns_.size(); ++i) {
      const double unit_s = fraction_unit_s(columns_[i]);
      const ForeignColumn& main = columns_[i - 1];
      const bool seconds = main.is_clock || (main.is_whole && main.parts.unit && main.parts.unit->name == "s");
      if (unit_s == 0.0 || !columns_[i].is_whole || !seconds) continue;
      const auto times = read_times(cells_of(i), layout_.decimal);  // of the column before
      bool fraction = times && times->whole, falls = main.constant;
      double last = 0.0;
      for (const double value : numbers_of(i + 1)) {
        if (!std::isfinite(value)) continue;
        fraction = fraction && value >= 0.0 && value * unit_s < 1.0;
        falls = falls || value < last;
        last = value;
      }
      if (fraction && falls) return i + 1;
    }
    return 0;
  }

  Status choose_roles() {
    list_rows();
    if (slots_.empty()) return fail("found no row of " + count_of(layout_.fields, "field") + " in these lines");
    measure_columns();
    fraction_ = find_fractions();
    std::vector<ForeignColumn> choices = columns_;
    if (fraction_ > 0) choices[fraction_ - 1] = {.header = columns_[fraction_ - 1].header};
    RoleRequest wanted = request_.columns;
    if (fraction_ > 0 && wanted[0].empty() && !request_.rate_Hz) wanted[0] = std::to_string(fraction_ - 1);
    const bool has_header = !layout_.names.empty();
    const RoleChoice choice = choose_columns(choices, wanted, has_header, !no_clock_);
    number_ = choice.number;
    const bool two_clocks = number_[1] > 0 && number_[2] > 0 && choice.times.size() > 1 && wanted[0].empty();
    if (!choice.problem.empty() && !two_clocks)
      return fail(
          choice.problem + ", expected one column for each of time, position and force" +
              (choice.problem.ends_with("the time") || !has_header ? ", or --rate HZ if the rows are evenly spaced"
                                                                   : "") +
              "; the columns are " + list_columns(columns_),
          choice.readings);
    for (const std::size_t role : {1u, 2u})
      if (choice.unnamed[role])
        note("warning: " + column_name(number_[role]) + " is taken as the " + kRoleNames[role] +
             ", because no other column can be it");
    std::ranges::remove_copy(choice.times, std::back_inserter(other_times_), number_[0]);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const std::string& header = columns_[i].header;
      if (header == kColumnNames[3]) velocity_ = i + 1;  // of a recording
      if (header == kColumnNames[4]) acceleration_ = i + 1;
    }
    return {};
  }

  // Refuses rows of several series: those that alternate, and those in sequence, unless the user chose the rows.
  Status refuse_series() {
    const auto refuse = [&](std::size_t series, const std::string& found) {
      return fail("found rows of " + std::to_string(series) + " series that alternate, by " + found +
                  ", expected one; write the rows of each into a file of its own");
    };
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const ForeignColumn& column = columns_[i];
      const bool few = column.values.size() > 1 && column.values.size() < kMostValues;
      if (std::ranges::count(number_, i + 1) > 0 || i + 1 == fraction_ || !few || column.is_units) continue;
      double number = 0.0;
      const bool is_text = !parse_table_number(column.values.front(), layout_.decimal, number);
      const bool alternates = 3 * column.changes > block_.rows;
      const std::vector<std::string> values(
          column.values.begin(), column.values.begin() + std::min<std::ptrdiff_t>(3, std::ssize(column.values)));
      if (alternates && (is_text || identifies(column)))
        return refuse(column.values.size(),
                      column_name(i + 1) + " (" + joined(values) + (column.values.size() > 3 ? ", ..." : "") + ")");
      if (!identifies(column) || alternates || request_.rows) continue;
      const Fields cells = cells_of(i + 1);
      std::vector<Reading> parts = parts_of([&](std::size_t last, std::size_t k) { return cells[k] != cells[last]; },
                                            [&](std::size_t k) { return !is_empty(cells[k]); },
                                            [&](std::size_t k) { return std::string(cells[k]); });
      parts.push_back({rows_option({block_.begin + 1, block_.end}), "all as one recording"});
      return fail("found rows of " + std::to_string(parts.size() - 1) + " series, by " + column_name(i + 1) +
                      ", expected one; choose the rows",
                  parts);
    }
    for (const std::size_t role : {1u, 2u}) {
      const std::vector<double> values = numbers_of(number_[role]);
      for (std::size_t apart = 2; apart <= kMostSeries; ++apart) {
        double neighbours = 0.0, series = 0.0;
        for (std::size_t i = apart; i < values.size(); ++i) {
          if (!std::isfinite(values[i] + values[i - 1] + values[i - apart])) continue;
          neighbours += std::abs(values[i] - values[i - 1]);
          series += std::abs(values[i] - values[i - apart]);
        }
        if (neighbours > kSeriesDifference * series)
          return refuse(apart, the_role(role) + ", which is nearer to that " + std::to_string(apart) +
                                   " rows above than to that of the row above (or a disturbance has this period)");
      }
    }
    return {};
  }

  // The unit of each role, from the user, the header, or the rows.
  Status find_units() {
    for (std::size_t role = 0; role < kRoles; ++role) {
      const std::size_t number = number_[role];
      if (number == 0) continue;
      table_.columns[role] = {number, layout_.names.empty() ? "" : columns_[number - 1].header};
      if (number < columns_.size() && columns_[number].is_units) unit_column_[role] = number + 1;
      const Status status = role == 0 ? find_time_unit() : find_unit_of(role);
      if (!status && (role > 0 || !request_.rate_Hz)) return status;
      if (!status) number_[0] = 0;  // the times are not needed
    }
    return {};
  }

  void use_unit(std::size_t role, std::string_view name, double to_si) {
    to_si_[role] = to_si;
    table_.columns[role].unit = name;
  }

  std::optional<Unit> given_unit(std::size_t role) const {
    const auto given = std::ranges::find(request_.units, static_cast<Quantity>(role), &Unit::quantity);
    return given != request_.units.end() ? std::optional(*given) : std::nullopt;
  }

  Status find_unit_of(std::size_t role) {
    constexpr const char* kQuantities[] = {"time", "length", "force"};
    const auto quantity = static_cast<Quantity>(role);
    const std::size_t number = number_[role];
    const NameAndUnit& parts = columns_[number - 1].parts;
    const std::string in_header = parts.unit ? std::string(parts.unit->name) : printable(parts.foreign_unit);
    const auto given = given_unit(role);
    if (!parts.contradicting.empty() && !given)
      return fail_at(layout_.header,
                     "found two units of " + the_role(role) + ", " + in_header + " and " + parts.contradicting +
                         ", expected one; correct the header, or give the unit of the numbers",
                     {{"--units " + in_header, "the first"}, {"--units " + parts.contradicting, "the second"}});
    std::optional<Unit> unit = given ? given : parts.unit;
    const bool fits = unit && unit->quantity == quantity;
    const double volts = role == 2 ? volts_of(parts.foreign_unit) : 0.0;
    if (role == 2 && request_.gain_N_per_V && (fits || !unit)) {
      if (parts.unit)
        note("warning: " + the_role(role) + " is read in V as --gain says, although its header says " + in_header);
      use_unit(role, "V", (volts > 0.0 ? volts : 1.0) * *request_.gain_N_per_V);
      return {};
    }
    if (volts > 0.0)
      return fail("found volts in the column" + quoted_name(number) +
                  ", expected a force; say how many newtons a volt is: --gain N_PER_V");
    // A unit beside or behind every value.
    std::vector<std::string> units;
    for (const std::string& cell : columns_[number - 1].values) {
      const auto found = parse_table_cell(cell, layout_.decimal);
      if (found && found->unit) units.emplace_back(found->unit->name);
    }
    if (unit_column_[role] > 0) units = columns_[unit_column_[role] - 1].values;
    for (const std::string& name : units) {
      const auto one = find_unit(name);
      if (one->quantity != quantity || (unit && one->to_si != unit->to_si))
        return fail("found the unit " + name + " in the rows of " + the_role(role) + ", expected " +
                    (one->quantity != quantity
                         ? std::string("a unit of ") + kQuantities[role]
                         : std::string(unit->name) + ", as " + (given ? "--units" : "the header") + " says") +
                    "; correct the one that is wrong");
    }
    if (!units.empty()) {
      const bool same = std::ranges::count(units, units.front()) == std::ssize(units);
      use_unit(role, same ? units.front() : "each row's unit", same ? find_unit(units.front())->to_si : 0.0);
      return {};
    }
    if (fits) {
      // A note where the unit of the user contradicts that of the header.
      if (parts.unit ? parts.unit->to_si != unit->to_si : !in_header.empty())
        note("warning: " + the_role(role) + " is read in " + std::string(unit->name) +
             " as --units says, although its header says " + in_header);
      use_unit(role, unit->name, unit->to_si);
      return {};
    }
    if (!parts.foreign_unit.empty() || (unit && role > 0))
      return fail_at(layout_.header, "found the unit \"" + in_header + "\" in " + column_name(number) +
                                         ", expected a unit of " + kQuantities[role] + " (" + unit_names(quantity) +
                                         "); convert the column, choose another with --columns " + kRoleNames[role] +
                                         "=NAME, or give the unit of the numbers with --units");
    return fail("found no unit of " + the_role(role) + ", expected one of " + unit_names(quantity) +
                "; add the unit of the numbers: --units " + (role == 1 ? "mm" : "N") +
                ", with a comma between two units: --units mm,N");
  }

  Status find_time_unit() {
    auto times = read_times(cells_of(number_[0]), layout_.decimal);
    if (!times) return fail_at(block_.begin + 1, times.error().message);
    times_ = std::move(*times);
    if (fraction_ > 0 && number_[0] + 1 == fraction_) {
      const double unit_s = fraction_unit_s(columns_[fraction_ - 1]);
      double first = std::nan("");
      const std::vector<double> parts = numbers_of(fraction_);
      for (std::size_t i = 0; i < parts.size(); ++i) {
        if (std::isnan(first) && std::isfinite(times_.since_first[i])) first = parts[i];
        times_.since_first[i] += unit_s * (parts[i] - first);
      }
      times_.measure_steps();
      use_unit(0, times_.of_a_clock ? "clock" : "s", 1.0);
      return {};
    }
    const auto& parts = columns_[number_[0] - 1].parts;
    const auto given = given_unit(0), stated = given ? given : parts.unit;
    if (times_.of_a_clock) {
      if (stated && stated->quantity == Quantity::time && stated->to_si != 1.0)
        return fail("found times of a clock in " + the_role(0) + ", expected numbers in " + std::string(stated->name) +
                        ", as " + (given ? "--units" : "the header") + " says",
                    given ? std::vector<Reading>() : std::vector<Reading>{{"--units s", "the times of the clock"}});
      use_unit(0, "clock", 1.0);
      return {};
    }
    if (given || !parts.foreign_unit.empty() || (parts.unit && parts.unit->quantity == Quantity::time))
      return find_unit_of(0);
    // Every unit in which the rate of the rows is possible, and that of a date, if the first time is one in one unit.
    std::vector<Reading> possible, dated;
    const double step = times_.median_step;
    for (const char* name : {"ns", "ticks", "us", "ms", "s", "min", "h", "days"}) {
      const double to_s = find_unit(name)->to_si, rate_Hz = 1.0 / (step * to_s);
      if (!(step > 0.0) || !rate_in_range(step * to_s)) continue;
      const bool common = std::string_view("ns us ms s").find(name) != std::string_view::npos;
      // The rate of a rare unit is a set one, unless the times are rounded or jitter.
      if (!common && times_.steady && !is_round(1.0 / (times_.plain_step * to_s))) continue;
      possible.push_back({std::string("--units ") + name, short_number(rate_Hz) + " Hz"});
      if (is_date(name, times_.first_cell * to_s)) dated.push_back(possible.back());
    }
    if (dated.size() == 1) possible = dated;
    // Steps of exactly 1 may also count the rows.
    if (possible.size() != 1 || (times_.whole && times_.steady && times_.plain_step == 1.0))
      return fail("found no unit of " + the_role(0) + " and steps of " + short_number(step) + ", expected one of " +
                      unit_names(Quantity::time) + "; add it with --units, or --rate HZ if the rows are evenly spaced",
                  possible);
    const auto unit = find_unit(possible.front().option.substr(8));
    note("the header has no unit of time: taken as " + std::string(unit->name) + ", in which the rate is " +
         possible.front().meaning);
    use_unit(0, unit->name, unit->to_si);
    table_.columns[0].guessed = true;
    return {};
  }

  // A rate or an interval that is set and not the result of another unit: 1, 2, 2.5, 4, 5 or 8 times a power of ten.
  static bool is_round(double rate_Hz) {
    const double digits = std::pow(10.0, std::log10(rate_Hz) - std::floor(std::log10(rate_Hz) + 1e-4));
    return std::ranges::any_of(std::array{1.0, 2.0, 2.5, 4.0, 5.0, 8.0},
                               [&](double round) { return std::abs(digits / round - 1.0) < 3e-3; });
  }
  // Whether a time is between the years 2000 and 2100: since 1970, in ticks since the year 1 or 1601, in days as those
  // of Excel and MATLAB.
  static bool is_date(std::string_view unit, double time_s) {
    std::vector<double> epochs_s = {0.0};
    if (unit == "ticks") epochs_s = {62135596800.0, 11644473600.0};
    if (unit == "days") epochs_s = {25569.0 * 86400.0, 719529.0 * 86400.0};
    return std::ranges::any_of(
        epochs_s, [&](double epoch_s) { return time_s - epoch_s > 946684800.0 && time_s - epoch_s < 4102444800.0; });
  }

  // The values of a role in SI; NaN where a cell cannot be read.
  std::vector<double> values_of(std::size_t role, const Fields& cells) const {
    const Fields units = unit_column_[role] > 0 ? cells_of(unit_column_[role]) : Fields();
    std::vector<double> values(cells.size(), std::nan(""));
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto cell = parse_table_cell(cells[i], layout_.decimal);
      if (!cell) continue;
      const std::optional<Unit> unit = units.empty() ? cell->unit : find_unit(units[i]);
      const double to_si = unit ? unit->to_si : to_si_[role];
      if (to_si != 0.0 && (!unit || unit->quantity == static_cast<Quantity>(role))) values[i] = to_si * cell->value;
    }
    return values;
  }

  // Reads every row. Rows that cannot be read keep their place in time.
  Status read_rows() {
    own_s_ = std::move(times_.since_first);
    for (double& time : own_s_) time *= to_si_[0];
    if (number_[0] == 0) own_s_.assign(slots_.size(), std::nan(""));
    for (const std::size_t role : {1u, 2u}) values_[role] = values_of(role, cells_of(number_[role]));
    const bool two_clocks = has_two_clocks();       // one channel may have fewer values than the other
    std::uint64_t unreadable = 0, other_forms = 0;  // cells with digits, but no numbers: "(0.1)", "0.1-"
    std::size_t first_bad = texts_ > 0 ? first_text_ : lines_.size() + 1;
    std::string fault;
    Fields fields;
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      Slot& slot = slots_[i];
      const std::array finite{no_clock_ || std::isfinite(own_s_[i]), std::isfinite(values_[1][i]),
                              std::isfinite(values_[2][i])};
      slot.good = slot.is_row && finite[0] && finite[1] && finite[2];
      if (slot.good || !slot.is_row || two_clocks) continue;
      ++unreadable;
      leave_out("unreadable", slot.line);
      const std::size_t number = number_[!finite[1] ? 1 : !finite[2] ? 2 : 0];
      split_table_fields(lines_[slot.line - 1], layout_.delimiter, fields);
      const std::string_view cell = number > fields.size() ? "" : fields[number - 1];
      if (!is_empty(cell) && cell.find_first_of("0123456789") != std::string_view::npos) ++other_forms;
      if (slot.line > first_bad || !fault.empty()) continue;
      first_bad = slot.line;
      fault = "found " + (cell.empty() ? "an empty field" : '"' + printable(cell) + '"') + " in " +
              column_name(number) + ", expected a number; repair the value";
    }
    const std::uint64_t bad = texts_ + unreadable;
    const bool none = std::ranges::none_of(slots_, &Slot::good) && !two_clocks;
    if (!none && bad <= request_.skip_bad_rows) return {};
    if (fault.empty())
      fault =
          "found \"" + printable(lines_[first_bad - 1]) + "\", expected a row of " + count_of(layout_.fields, "field");
    if (none) return fail_at(first_bad, fault + "; no row has both position and force");
    // Where many cells have a form of their own, the others alone are another recording.
    if (other_forms > kOtherForms || kMostBad * bad > slots_.size()) return fail_at(first_bad, fault);
    std::vector<Reading> readings{{"--skip-bad-rows " + std::to_string(bad),
                                   "without " + count_of(bad, "such row") + "; the other rows keep their times"}};
    if (no_clock_ && texts_ > 0)  // which may separate two recordings
      std::ranges::copy(parts_of([&](std::size_t last, std::size_t i) { return i > last + 1; },
                                 [&](std::size_t i) { return slots_[i].is_row; },
                                 [](std::size_t) { return std::string("rows without a break"); }),
                        std::back_inserter(readings));
    return fail_at(first_bad, fault + (first_bad == first_text_ ? "" : ", or leave the row out"), readings);
  }

  // Refuses times that go back, hours, minutes and seconds as one number, and clocks that contradict each other.
  Status check_times() {
    if (times_.midnights > 0) note("the clock passes midnight: a day is added from there");
    const double step_s = to_si_[0] * times_.median_step, first_s = to_si_[0] * times_.first_cell;
    double last_s = 0.0, most_s = 0.0;
    std::size_t first_back = 0;
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      if (!std::isfinite(own_s_[i])) continue;
      if (own_s_[i] < last_s && first_back == 0) first_back = slots_[i].line;
      most_s = std::max(most_s, last_s - own_s_[i]);
      // 140359.99 is followed by 140400.00, and 145959.99 by 150000.00.
      const double beyond_s = std::fmod(own_s_[i] - last_s, 4000.0) - 40.0, few_s = kSwappedSteps * step_s;
      if (!no_clock_ && !times_.of_a_clock && rate_in_range(step_s) && std::abs(beyond_s) < few_s &&
          std::fmod(first_s + own_s_[i], 100.0) < few_s)
        return fail_at(slots_[i].line, "found a time " + short_number(own_s_[i] - last_s) +
                                           " s after that of the row above" + quoted_name(number_[0]) +
                                           " at a multiple of 100 s, as where hours, minutes and seconds are written "
                                           "as one number; write seconds, or 14:03:22.010");
      last_s = own_s_[i];
    }
    const bool restarts = most_s > kSwappedSteps * step_s;
    if (first_back == 0 || (!restarts && request_.rate_Hz)) return has_two_clocks() ? Status() : compare_clocks();
    std::vector<Reading> parts = parts_of([&](std::size_t last, std::size_t i) { return own_s_[i] < own_s_[last]; },
                                          [&](std::size_t i) { return std::isfinite(own_s_[i]); },
                                          [](std::size_t) { return std::string("times that do not go back"); });
    std::string wrap;
    for (const int bits : {16, 32})
      if (std::abs(most_s / to_si_[0] - std::exp2(bits)) < kSwappedSteps * times_.median_step)
        wrap = ", as where a counter of " + std::to_string(bits) + " bits begins again (add 2^" + std::to_string(bits) +
               " to its values from there on)";
    const bool many = parts.size() > kMostReadings;
    if (many) parts.clear();
    for (const std::size_t other : other_times_)
      parts.insert(parts.begin(), {"--columns time=" + std::to_string(other),
                                   "the times of \"" + printable(columns_[other - 1].header) + '"'});
    const double rate_Hz = static_cast<double>(slots_.size() - 1) / std::max(last_s, step_s);
    if (!restarts && rate_in_range(1.0 / rate_Hz))
      parts.insert(parts.begin(), {"--rate " + short_number(rate_Hz), "if the rows are evenly spaced"});
    return fail_at(first_back,
                   "found a time " + short_number(most_s) + " s before that of the row above" +
                       quoted_name(number_[0]) + wrap + ", expected later times in every row; " +
                       (many ? "sort the rows, or split the file" : "choose the rows"),
                   parts);
  }

  // The times of another column in s; empty if it has none.
  ColumnTimes clock_in_s(std::size_t number) const {
    auto times = read_times(cells_of(number), layout_.decimal);
    if (!times) return {};
    const auto& unit = columns_[number - 1].parts.unit;
    const bool stated = unit && unit->quantity == Quantity::time;
    const double to_s = times->of_a_clock ? 1.0 : stated ? unit->to_si : to_si_[0];
    times->first_cell *= to_s;
    for (double& time : times->since_first) time *= to_s;
    return std::move(*times);
  }

  Status compare_clocks() {
    if (number_[0] == 0 || !std::isfinite(own_s_.front()) || !std::isfinite(own_s_.back())) return {};
    for (const std::size_t other : other_times_) {
      if (!request_.columns[0].empty()) break;
      const ColumnTimes clock = clock_in_s(other);
      const std::vector<double>& seconds = clock.since_first;
      // A clock with hours and minutes may be that of the arrival; its duration must be that of the times.
      const bool rival = !columns_[other - 1].is_clock || times_.of_a_clock;
      double apart_s = 0.0;
      for (std::size_t i = 0; i < seconds.size(); ++i)
        if (std::isfinite(own_s_[i] - seconds[i])) apart_s = std::max(apart_s, std::abs(own_s_[i] - seconds[i]));
      const double limit_s =
          rival ? 0.5 * to_si_[0] * times_.median_step : std::max(kDuration_s, kDurationShare * own_s_.back());
      if (apart_s <= limit_s + (clock.of_a_clock && clock.whole ? 1.0 : 0.0)) continue;
      std::vector<Reading> readings;
      for (const std::size_t number : {number_[0], other})
        readings.push_back({"--columns time=" + std::to_string(number),
                            '"' + printable(columns_[number - 1].header) +
                                "\": " + short_number(number == other ? seconds.back() : own_s_.back()) + " s"});
      return fail("found two clocks that differ by up to " + short_number(apart_s) + " s, in columns " +
                      std::to_string(number_[0]) + quoted_name(number_[0]) + " and " + std::to_string(other) +
                      quoted_name(other) + ", expected one; choose the time",
                  readings);
    }
    return {};
  }

  double lab(const std::vector<double>& values, std::size_t role) const {
    return number_[role] <= values.size() ? values[number_[role] - 1] : 0.0;
  }
  // The column of times that is the nearest before the position and before the force.
  std::array<std::size_t, kRoles> clock_columns() const {
    std::array<std::size_t, kRoles> clocks{};
    std::vector<std::size_t> times = other_times_;
    times.push_back(number_[0]);
    for (const std::size_t role : {1u, 2u})
      for (const std::size_t time : times)
        if (time < number_[role]) clocks[role] = std::max(clocks[role], time);
    if (clocks[1] == 0 || clocks[2] == 0) clocks[1] = clocks[2] = number_[0];
    return clocks;
  }
  // Whether the intervals of LabVIEW or the columns of times before the two channels differ.
  bool has_two_clocks() const {
    if (request_.rate_Hz) return false;
    const auto &steps = layout_.steps_s, &starts = layout_.starts_s;
    if (!steps.empty()) return lab(steps, 1) != lab(steps, 2) || lab(starts, 1) != lab(starts, 2);
    const auto clocks = clock_columns();
    return clocks[1] != clocks[2] && cells_of(clocks[1]) != cells_of(clocks[2]);
  }

  // Two channels with clocks of their own, on the times of the faster one.
  Status resample() {
    struct Point {
      double time_s, value;
      std::size_t line;
    };
    std::array<std::vector<Point>, kRoles> channels;
    std::array<double, kRoles> steps_s{};
    const auto clocks = clock_columns();
    for (const std::size_t role : {1u, 2u}) {
      ColumnTimes clock;
      if (layout_.steps_s.empty()) clock = clock_in_s(clocks[role]);
      const double first_s = layout_.steps_s.empty() ? clock.first_cell : lab(layout_.starts_s, role);
      for (std::size_t i = 0; !layout_.steps_s.empty() && i < slots_.size(); ++i)
        clock.since_first.push_back(static_cast<double>(i) * lab(layout_.steps_s, role));
      std::vector<Point>& channel = channels[role];
      for (std::size_t i = 0; i < clock.since_first.size(); ++i) {
        const Point point{first_s + clock.since_first[i], values_[role][i], slots_[i].line};
        if (!std::isfinite(point.time_s + point.value)) continue;
        if (!channel.empty() && point.time_s <= channel.back().time_s)
          return fail_at(point.line, "found a time of the " + std::string(kRoleNames[role]) +
                                         " that is not later than that above, expected later times in every row");
        channel.push_back(point);
      }
      if (channel.size() < 2) return fail("found no values of the " + std::string(kRoleNames[role]));
      steps_s[role] = (channel.back().time_s - channel.front().time_s) / static_cast<double>(channel.size() - 1);
    }
    const std::size_t slow = steps_s[1] >= steps_s[2] ? 1 : 2, fast = 3 - slow;
    const auto &own = channels[fast], &other = channels[slow];
    const double begin_s = std::min(own.front().time_s, other.front().time_s);
    std::string found = "found two clocks, with";
    for (const std::size_t role : {1u, 2u})
      found += std::string(role == 1 ? " a " : " and a ") + kRoleNames[role] + " every " + short_number(steps_s[role]) +
               " s from " + short_number(channels[role].front().time_s - begin_s) + " s on";
    std::size_t after = 1;
    double error = 0.0;
    for (const Point& point : own) {
      if (point.time_s < other.front().time_s - 1e-9 || point.time_s > other.back().time_s + 1e-9) {
        leave_out(slow == 1 ? "without a position at the time" : "without a force at the time", point.line);
        continue;
      }
      while (after + 1 < other.size() && other[after].time_s < point.time_s) ++after;
      const Point &from = other[after - 1], &to = other[after];
      const double share = (point.time_s - from.time_s) / (to.time_s - from.time_s);
      const double between = from.value + share * (to.value - from.value);
      // The error of a linear interpolation, from the second differences beside.
      for (std::size_t i = std::max<std::size_t>(after, 2); i <= std::min(after + 1, other.size() - 1); ++i)
        error = std::max(
            error, share * (1.0 - share) * std::abs(other[i].value - 2.0 * other[i - 1].value + other[i - 2].value));
      table_.recording.rows.push_back(
          {point.time_s - begin_s, slow == 1 ? between : point.value, slow == 1 ? point.value : between});
    }
    const auto [low, high] = std::ranges::minmax(other, {}, &Point::value);
    const std::string slow_name = kRoleNames[slow];
    if (error > kInterpolationShare * (high.value - low.value))
      return fail(found + ", expected one, or a " + slow_name +
                  " that is fast enough to be interpolated; export both channels with one interval");
    note("warning: " + found + ": the " + slow_name + " is interpolated at the times of the " + kRoleNames[fast]);
    table_.columns[0].number = clocks[fast];
    if (clocks[fast] > 0 && !layout_.names.empty()) table_.columns[0].header = columns_[clocks[fast] - 1].header;
    return {};
  }

  // The place of each row in time: its number, or that of a column that counts the rows and skips some.
  std::vector<double> places_of_rows() {
    std::vector<double> places(slots_.size());
    std::iota(places.begin(), places.end(), 0.0);
    for (std::size_t i = 0; i < columns_.size() && slots_.size() > kCountedRows; ++i) {
      const ForeignColumn& column = columns_[i];
      if (!column.is_whole || column.changes + 1 < slots_.size() || std::ranges::count(number_, i + 1) > 0) continue;
      std::vector<double> counts = numbers_of(i + 1), steps;
      for (std::size_t k = 1; k < counts.size(); ++k) steps.push_back(counts[k] - counts[k - 1]);
      const double step = median_of(steps), first = counts.front();
      const bool multiples = step > 0.0 && std::ranges::all_of(steps, [&](double one) {
                               return one >= step && std::fmod(one, step) == 0.0;
                             });
      for (double& count : counts) count = (count - first) / step;
      const double gaps = counts.back() - places.back();
      if (!multiples || gaps == 0.0) continue;
      note("warning: " + column_name(i + 1) + " counts the rows and skips " + short_number(gaps) +
           " of them: the others keep their times");
      return counts;
    }
    return places;
  }

  // Refuses a clock that is so coarse that rows with other values have the time of the row above.
  Status refuse_coarse_clock() {
    std::size_t shared = 0, first = 0, last = 0, doubled = 0;  // first, last: slots at which the time changes
    std::uint64_t bad = texts_;
    for (std::size_t i = 0, above = slots_.size(); i < slots_.size(); ++i) {
      if (!slots_[i].good) {
        ++bad;
        continue;
      }
      const std::size_t before = std::exchange(above, i);
      if (before == slots_.size()) continue;
      const double step_s = own_s_[i] - own_s_[before];
      if (step_s > 0.0) last = i, first = first > 0 ? first : i;
      if (std::abs(step_s / (to_si_[0] * times_.plain_step) - 2.0) < kEqualSteps) ++doubled;
      if (step_s == 0.0 && (values_[1][i] != values_[1][before] || values_[2][i] != values_[2][before])) ++shared;
    }
    if (static_cast<double>(doubled) > kDoubledSteps * static_cast<double>(slots_.size()))
      note("warning: " + count_of(doubled, "step") +
           " of the time are twice the others: rows are missing, or the clock is as coarse as the rows are apart; if " +
           "they are evenly spaced, add --rate HZ");
    if (shared == 0 || bad + shared <= request_.skip_bad_rows) return {};
    std::vector<Reading> readings;
    if (last > first) {
      // The rows between two changes of the time are known to one row.
      const auto between = static_cast<double>(last - first);
      double rate_Hz = between / (own_s_[last] - own_s_[first]);
      if (std::abs(std::round(rate_Hz) - rate_Hz) * between <= 2.0 * rate_Hz) rate_Hz = std::round(rate_Hz);
      if (rate_in_range(1.0 / rate_Hz))
        readings.push_back({"--rate " + short_number(rate_Hz), "the mean rate, if the rows are evenly spaced"});
    }
    if (kMostBad * (bad + shared) <= slots_.size())
      readings.push_back({"--skip-bad-rows " + std::to_string(bad + shared), "without these rows"});
    return fail("found the time of the row above" + quoted_name(number_[0]) + " in " + count_of(shared, "row") +
                    " with other values, expected a later time in every row; write the times with more digits",
                readings);
  }

  // Gives every row its time.
  Status set_times() {
    table_.lines = {slots_.front().line, slots_.back().line};
    if (has_two_clocks()) return resample();
    double rate_Hz = request_.rate_Hz.value_or(0.0);
    if (rate_Hz > 0.0) {
      note("the rows are evenly spaced at the --rate of " + short_number(rate_Hz) + " Hz");
    } else if (!layout_.steps_s.empty() && lab(layout_.steps_s, 1) > 0.0) {
      rate_Hz = 1.0 / lab(layout_.steps_s, 1);
      number_[0] = 0;
      note("the rows are evenly spaced by the Delta_X above the table");
    } else if (const Status fine = refuse_coarse_clock(); !fine) {
      return fine;
    }
    const std::vector<double> places = rate_Hz > 0.0 ? places_of_rows() : std::vector<double>();
    const std::vector<double> velocities = numbers_of(velocity_), accelerations = numbers_of(acceleration_);
    auto& recording = table_.recording;
    recording.columns = {velocity_ > 0, acceleration_ > 0};
    // Everything is read: frees the text before the rows are made.
    lines_ = {};
    std::string().swap(text_);
    recording.rows.reserve(slots_.size());
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      if (velocity_ > 0 && std::isnan(velocities[i])) recording.columns = {};
      if (acceleration_ > 0 && std::isnan(accelerations[i])) recording.columns = {};
      if (!slots_[i].good) continue;
      const double time_s = rate_Hz > 0.0 ? places[i] / rate_Hz : own_s_[i];
      if (!recording.rows.empty() && time_s == recording.rows.back().time_s) {
        leave_out("with the time of the row above", slots_[i].line);
        continue;
      }
      recording.rows.push_back({time_s, values_[1][i], values_[2][i], velocity_ > 0 ? velocities[i] : 0.0,
                                acceleration_ > 0 ? accelerations[i] : 0.0});
    }
    const double seconds = recording.rows.back().time_s, own_s = own_s_.back();
    if (request_.rate_Hz && own_s > 0.0 && std::abs(seconds - own_s) > kDurationShare * own_s)
      note("warning: with --rate " + short_number(rate_Hz) + " the recording is " + short_number(seconds) +
           " s long, but " + short_number(own_s) + " s by the times in the file");
    if (rate_Hz == 0.0 && times_.of_a_clock)
      note(times_.with_dates ? "the times are dates: time_s is 0 at the first row"
                             : "the times are times of day: time_s is 0 at the first row");
    return {};
  }

  // Applies the signs, and checks what does not depend on a moved zero.
  Status finish() {
    auto& recording = table_.recording;
    RowRules rules;
    for (RecordingRow& row : recording.rows) {
      if (request_.flip_position) row.position_m = -row.position_m;
      if (request_.flip_force) row.force_N = -row.force_N;
      const bool with_velocity = recording.columns.velocity, with_acceleration = recording.columns.acceleration;
      const double sign = request_.flip_position ? -1.0 : 1.0;
      row.velocity_m_per_s = with_velocity ? sign * row.velocity_m_per_s : 0.0;
      row.acceleration_m_per_s2 = with_acceleration ? sign * row.acceleration_m_per_s2 : 0.0;
      if (const auto fault = rules.check({row.time_s, 0.0, 0.0})) return fail_at(table_.lines.first, fault->text);
    }
    if (const auto fault = rules.finish()) return fail(fault->text);
    if (number_[0] == 0 || request_.rate_Hz) table_.columns[0] = {};
    table_.delimiter = layout_.delimiter.name;
    table_.decimal = layout_.decimal == ',' ? "comma" : "point";
    table_.header_line = layout_.header;
    recording.name = printable(std::filesystem::path(path_).stem().string(), std::string::npos);
    return {};
  }

  const std::string& path_;
  const ImportRequest& request_;
  std::string text_;
  std::vector<std::string_view> lines_;
  ImportedTable table_;
  TableLayout layout_;
  RowBlock block_;
  bool no_clock_ = false;  // the rows are evenly spaced
  std::vector<Slot> slots_;
  std::uint64_t texts_ = 0;     // lines of text between the rows
  std::size_t first_text_ = 0;  // the first of them, from 1
  std::vector<ForeignColumn> columns_;
  std::array<std::size_t, kRoles> number_{}, unit_column_{};  // from 1; 0: none
  std::array<double, kRoles> to_si_{};
  std::vector<std::size_t> other_times_;
  std::size_t fraction_ = 0, velocity_ = 0, acceleration_ = 0;
  ColumnTimes times_;
  std::vector<double> own_s_;                       // the time of each slot in the file
  std::array<std::vector<double>, kRoles> values_;  // of each slot in SI; NaN: none
};

}  // namespace

Result<ImportedTable> import_table(const std::string& path, const ImportRequest& request) {
  auto text = read_foreign_text(path);
  if (!text) return text.error();
  return Importer(std::move(*text), path, request).run();
}

Status check_limits(const std::string& path, const ImportRequest& request, const ImportedTable& table) {
  const auto& rows = table.recording.rows;
  const auto [low, high] = std::ranges::minmax(rows, {}, &RecordingRow::position_m);
  const double farthest_m = std::abs(low.position_m) > std::abs(high.position_m) ? low.position_m : high.position_m;
  if (std::abs(farthest_m) > kMaximumPosition_m) {
    const std::string found = ": found the position " + short_number(farthest_m) +
                              " m, expected metres from the surface, at most 1 either way; ";
    if (high.position_m - low.position_m <= kMaximumPosition_m)
      return refusal(path, request, found + "move position 0",
                     {{"--zero contact", "where the force begins"}, {"--zero first", "the first row"}});
    return refusal(path, request, found + "give the unit of " + column_words(table.columns[1]) + " with --units");
  }
  const auto strong =
      std::ranges::find_if(rows, [](const auto& row) { return std::abs(row.force_N) > kMaximumForce_N; });
  if (strong != rows.end())
    return refusal(path, request,
                   ": found the force " + short_number(strong->force_N) +
                       " N, expected at most 1000000 either way; give the unit of " + column_words(table.columns[2]) +
                       " with --units");
  return {};
}

std::string layout_words(const ImportedTable& table) {
  return std::string(table.delimiter) + " between fields, decimal " + std::string(table.decimal) + ", " +
         std::string(table.encoding) +
         (table.header_line > 0 ? ", header in line " + std::to_string(table.header_line) : ", no header");
}

std::vector<std::string> row_words(const ImportedTable& table) {
  std::vector<std::string> words = {std::to_string(table.recording.rows.size()) + " read, " + lines_words(table.lines)};
  for (const LeftOut& one : table.left_out)
    words.push_back("left out " + count_of(one.rows, "row") + " (" + one.reason + "), " + lines_words(one.lines));
  return words;
}

std::string column_words(const ImportedColumn& column) {
  if (column.number == 0) return "evenly spaced";
  const std::string name = column.header.empty() ? "" : " \"" + printable(column.header) + "\"";
  return "column " + std::to_string(column.number) + name + " in " + column.unit + (column.guessed ? " (guessed)" : "");
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
  for (std::size_t role = 0; role < kRoles; ++role)
    comments.push_back(std::string(kRoleNames[role]) + ": " + column_words(table.columns[role]));
  for (const std::string& flip : flipped_roles(request)) comments.push_back(flip + ": sign reversed");
  for (const std::string& rows : row_words(table)) comments.push_back("rows: " + rows);
  std::ranges::copy_if(table.notes, std::back_inserter(comments),
                       [](const std::string& note) { return note.starts_with("warning:"); });
  return comments;
}

}  // namespace palpate
