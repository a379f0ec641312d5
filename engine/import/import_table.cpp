#include "engine/import/import_table.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <utility>

#include "engine/base/statistics.h"
#include "engine/base/text.h"
#include "engine/import/table_parts.h"

namespace palpate {
namespace {

// A channel is slower than the rows if it has no value in so many rows.
constexpr std::uint64_t kSlowRows = 10;
// A longer list of blocks is cut.
constexpr std::size_t kMostReadings = 12;
// A time that goes back by more steps begins another recording.
constexpr double kSwappedSteps = 3.0;
// Two channels are not resampled where the interpolation of the slower one errs by more than this share of its range.
constexpr double kInterpolationShare = 0.01;
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

// An error with the readings that remain, each as a command.
Error refusal(const std::string& path, const ImportRequest& request, const std::string& text,
              const std::vector<Reading>& readings = {}) {
  std::string message = path + text;
  const std::string command =
      request.command.empty() ? "palpate import " + shell_word(path) + " --out REC.csv" : request.command;
  for (std::size_t i = 0; i < std::min(readings.size(), kMostReadings); ++i)
    message += "\n  " + command + " " + readings[i].option + "  # " + readings[i].meaning;
  if (readings.size() > kMostReadings)
    message += "\n  and " + std::to_string(readings.size() - kMostReadings) + " more";
  return Error{message};
}

// The values of one role at the times of its own clock.
struct Channel {
  std::vector<double> times_s, values;
  std::vector<std::uint64_t> lines;

  double step_s() const {
    return (times_s.back() - times_s.front()) / static_cast<double>(std::max<std::size_t>(times_s.size() - 1, 1));
  }
  // Linear interpolation; `after`: the index of the last call, for rising times. `error`: raised to the error that the
  // second differences of the values beside allow.
  double at(double time_s, std::size_t& after, double& error) const {
    while (after + 1 < times_s.size() && times_s[after] < time_s) ++after;
    const double step_s = times_s[after] - times_s[after - 1];
    const double share = step_s > 0.0 ? (time_s - times_s[after - 1]) / step_s : 0.0;
    for (std::size_t i = std::max<std::size_t>(after, 2); i <= std::min(after + 1, values.size() - 1); ++i)
      error = std::max(error, share * (1.0 - share) * std::abs(values[i] - 2.0 * values[i - 1] + values[i - 2]));
    return values[after - 1] + share * (values[after] - values[after - 1]);
  }
};

struct Row {
  RecordingRow row;
  std::uint64_t line = 0;
  std::optional<double> own_s{};  // its time in the file
  bool good = true;
};

class Importer {
 public:
  Importer(const ForeignText& foreign, const std::string& path, const ImportRequest& request)
      : path_(path), request_(request), lines_(lines_of(foreign.text)), has_arrivals_(foreign.has_arrivals) {
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
  Error fail(const std::string& text, const std::vector<Reading>& readings = {}) const {
    return refusal(path_, request_, ": " + text, readings);
  }
  Error fail_at(std::uint64_t line, const std::string& text, const std::vector<Reading>& readings = {}) const {
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
  std::string_view field(std::size_t number) const {  // of the present row
    return number > 0 && number <= fields_.size() ? fields_[number - 1] : std::string_view();
  }
  bool is_empty(std::size_t number) const { return field(number).empty() || is_missing_value(field(number)); }
  // ' "Weg [mm]"' for a message; empty without a header.
  std::string quoted_name(std::size_t number) const {
    return layout_.names.empty() ? "" : " \"" + printable(columns_[number - 1].header) + "\"";
  }
  std::string the_columns() const { return "; the columns are " + list_columns(columns_); }

  // Finds the block of rows that is the table.
  Status find_rows() {
    std::size_t before = 0, after = lines_.size();
    if (request_.rows) {
      before = std::min<std::size_t>(request_.rows->first - 1, lines_.size());
      after = std::max(before, std::min<std::size_t>(request_.rows->last, lines_.size()));
    }
    auto layout = find_table_layout(
        {lines_.begin() + static_cast<std::ptrdiff_t>(before), lines_.begin() + static_cast<std::ptrdiff_t>(after)},
        request_.decimal, request_.skip_bad_rows);
    if (!layout) return fail(layout.error().message);
    layout_ = std::move(*layout);
    std::vector<Reading> readings;
    std::size_t between = 0;
    for (RowBlock& block : layout_.blocks) {
      block.begin += before;
      block.end += before;
      if (!readings.empty())
        for (std::size_t i = block.begin; !trimmed(lines_[i - 1]).empty() && i > end_of_block_; --i) ++between;
      end_of_block_ = block.end;
      readings.push_back({"--block " + std::to_string(readings.size() + 1),
                          lines_words({block.begin + 1, block.end}) + ": " + count_of(block.rows, "row") + " of " +
                              count_of(block.fields, "field")});
    }
    if (request_.block > readings.size())
      return fail("found " + count_of(readings.size(), "block") + " of rows, expected at least " +
                  std::to_string(request_.block));
    if (request_.block == 0 && readings.size() > 1) {
      if (layout_.skippable)
        readings.insert(readings.begin(), {"--skip-bad-rows " + std::to_string(request_.skip_bad_rows + between),
                                           "all rows, without the text between them"});
      return fail("found numbers in " + count_of(layout_.blocks.size(), "block") +
                      ", expected one table that explains every row; choose the rows",
                  readings);
    }
    block_ = layout_.blocks[std::max<std::size_t>(request_.block, 1) - 1];
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

  // Refuses a header that does not determine the columns, unless the user gives their numbers.
  Status check_header() {
    if (!layout_.misfit && layout_.rival == 0) return {};
    const auto first_role = request_.rate_Hz ? 1 : 0;
    const bool decided = std::all_of(
        request_.columns.begin() + first_role, request_.columns.end(),
        [](const auto& name) { return !name.empty() && name.find_first_not_of("0123456789") == std::string::npos; });
    const std::string advice = std::string("or say which column is which by their numbers: --columns ") +
                               (first_role == 0 ? "time=N," : "") + "position=N,force=N";
    if (!layout_.misfit) {
      if (decided) return {};
      const auto [upper, lower] = std::minmax(layout_.header, layout_.rival);
      return fail_at(upper, "found names of columns in this line and in line " + std::to_string(lower) +
                                " that put the position and the force into different columns, expected one header; "
                                "remove the wrong line, " +
                                advice);
    }
    std::vector<std::string> names;
    for (const std::string_view name : layout_.names) names.push_back('"' + printable(name) + '"');
    const std::string found = std::to_string(names.size()) + " names (" + joined(names) + "), but the rows from line " +
                              std::to_string(block_.begin + 1) + " have " + count_of(layout_.columns, "field");
    if (!decided)
      return fail_at(layout_.header,
                     "found a header of " + found + ", expected a name for each field; correct the header, " + advice);
    note("warning: the header in line " + std::to_string(layout_.header) + " is not used: it has " + found);
    layout_.names.clear();
    layout_.header = 0;
    return {};
  }

  // Describes each column from all its rows.
  void measure_columns() {
    columns_.resize(layout_.columns);
    for (std::size_t i = 0; i < columns_.size() && !layout_.names.empty(); ++i) {
      ForeignColumn& column = columns_[i];
      column.header = layout_.names[i];
      column.parts = header_parts(column.header);
      if (i >= layout_.units.size()) continue;
      const std::string_view text = layout_.units[i];
      const auto unit = find_unit(text);
      const auto& stated = column.parts.unit;
      if (unit && stated && unit->to_si != stated->to_si) column.other_unit = text;
      if (unit && !stated) column.parts.unit = unit;
      if (!unit && !stated && text.find_first_not_of("-[]() ") != std::string_view::npos)
        column.parts.foreign_unit = text;
    }
    std::vector<std::string_view> above(columns_.size());
    bool first = true;
    for (std::size_t line = block_.begin; line < block_.end; ++line) {
      if (!is_row(layout_, lines_[line], fields_)) continue;
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        ForeignColumn& column = columns_[i];
        const std::string_view cell = field(i + 1);
        if (first && layout_.names.empty()) column.header = cell;
        if (cell.empty() || is_missing_value(cell)) continue;
        if (!above[i].empty() && cell == above[i]) continue;
        if (!above[i].empty()) {
          ++column.changes;
          column.constant = false;
        }
        above[i] = cell;
        if (column.values.size() < kMostValues && std::ranges::find(column.values, cell) == column.values.end())
          column.values.emplace_back(cell);
        column.is_units = column.is_units && find_unit(cell);
        column.is_clock = column.is_clock && is_of_a_clock(cell);
        column.is_whole = column.is_whole && cell.find_first_not_of("-+0123456789") == std::string_view::npos;
      }
      first = false;
    }
    for (ForeignColumn& column : columns_)
      if (column.values.empty()) column.is_units = column.is_clock = column.is_whole = false;
  }

  Fields cells_of(std::size_t number) const {
    Fields cells, fields;
    for (std::size_t line = block_.begin; line < block_.end; ++line) {
      if (!is_row(layout_, lines_[line], fields)) continue;
      cells.push_back(number <= fields.size() ? fields[number - 1] : std::string_view());
    }
    return cells;
  }

  // A column that counts the parts of the seconds of the column before it.
  std::size_t find_fractions() {
    for (std::size_t i = 1; i < columns_.size(); ++i) {
      const double unit_s = fraction_unit_s(columns_[i]);
      const ForeignColumn& main = columns_[i - 1];
      const auto& main_unit = main.parts.unit;
      const bool seconds = main.is_clock || (main.is_whole && main_unit && main_unit->quantity == Quantity::time &&
                                             main_unit->to_si == 1.0);
      if (unit_s == 0.0 || !columns_[i].is_whole || !seconds) continue;
      const Fields cells = cells_of(i + 1), whole = cells_of(i);
      RowTimes times;
      if (!times.examine(whole, layout_.decimal) || !times.are_whole_seconds()) continue;
      double last = 0.0, value = 0.0;
      bool below_1s = true, falls = main.changes == 0;
      for (const std::string_view cell : cells) {
        if (!parse_table_number(cell, layout_.decimal, value)) continue;
        below_1s = below_1s && value >= 0.0 && value * unit_s < 1.0;
        falls = falls || value < last;
        last = value;
      }
      if (below_1s && falls) return i + 1;
    }
    return 0;
  }

  Status choose_roles() {
    measure_columns();
    fraction_ = find_fractions();
    std::vector<ForeignColumn> choices = columns_;
    if (fraction_ > 0) choices[fraction_ - 1] = {.header = columns_[fraction_ - 1].header};
    RoleRequest wanted = request_.columns;
    if (fraction_ > 0 && wanted[0].empty() && !request_.rate_Hz) wanted[0] = std::to_string(fraction_ - 1);
    const bool has_header = !layout_.names.empty();
    const bool by_interval = request_.rate_Hz || !layout_.steps_s.empty();
    const RoleChoice choice = choose_columns(choices, wanted, has_header, !by_interval);
    if (!choice.problem.empty()) {
      const bool no_time = choice.problem.ends_with("the time") || !has_header;
      if (choice.number[1] == 0 || choice.number[2] == 0 || choice.times.size() < 2 || !wanted[0].empty())
        return fail(choice.problem + ", expected one column for each of time, position and force" +
                        (no_time ? ", or --rate HZ if the rows are evenly spaced" : "") + the_columns(),
                    choice.readings);
    }
    number_ = choice.number;
    for (const std::size_t other : choice.times)
      if (other != number_[0]) other_times_.push_back(other);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const std::string& header = columns_[i].header;
      if (header == kColumnNames[3]) velocity_ = i + 1;  // of a recording
      if (header == kColumnNames[4]) acceleration_ = i + 1;
    }
    return {};
  }

  // Refuses rows of several series: those that alternate, and those in sequence, unless the user chose the rows.
  Status refuse_series() {
    const auto is_role = [&](std::size_t number) {
      return std::ranges::find(number_, number) != number_.end() || number == fraction_;
    };
    const bool repeats = number_[0] > 0 && columns_[number_[0] - 1].changes < 7 * block_.rows / 10;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const ForeignColumn& column = columns_[i];
      const bool few = column.values.size() > 1 && column.values.size() < kMostValues;
      if (is_role(i + 1) || !few || column.is_units) continue;
      double number = 0.0;
      const bool is_text = !parse_table_number(column.values.front(), layout_.decimal, number);
      const bool alternates = 3 * column.changes > block_.rows;
      if (alternates && (is_text || identifies(column) || (repeats && column.is_whole))) {
        std::vector<std::string> values(column.values.begin(),
                                        column.values.begin() + std::min<std::ptrdiff_t>(3, std::ssize(column.values)));
        return fail("found rows of " + std::to_string(column.values.size()) + " series that alternate, by column " +
                    std::to_string(i + 1) + quoted_name(i + 1) + " (" + joined(values) +
                    (values.size() < column.values.size() ? ", ..." : "") +
                    "), expected one; write the rows of each into a file of its own");
      }
      if (identifies(column) && !alternates && !request_.rows) return refuse_sequence(i + 1);
    }
    return {};
  }

  Error refuse_sequence(std::size_t number) {
    std::vector<Reading> parts;
    std::string value;
    LineRange part;
    for (std::size_t line = block_.begin; line < block_.end; ++line) {
      if (!is_row(layout_, lines_[line], fields_) || is_empty(number)) continue;
      if (part.first > 0 && field(number) != value) {
        parts.push_back(reading_of(part, value));
        part.first = 0;
      }
      value = field(number);
      part = {part.first > 0 ? part.first : line + 1, line + 1};
    }
    parts.push_back(reading_of(part, value));
    parts.push_back(reading_of({block_.begin + 1, block_.end}, "all as one recording"));
    return fail("found rows of " + std::to_string(parts.size() - 1) + " series, by column " + std::to_string(number) +
                    quoted_name(number) + ", expected one; choose the rows",
                parts);
  }

  static Reading reading_of(const LineRange& part, const std::string& meaning) {
    return {"--rows " + std::to_string(part.first) + "-" + std::to_string(part.last), meaning};
  }

  // The unit of each role, from the user, the header, or the rows.
  Status find_units() {
    for (std::size_t role = 0; role < kRoles; ++role) {
      if (number_[role] == 0) continue;
      const ForeignColumn& column = columns_[number_[role] - 1];
      table_.columns[role] = {number_[role], layout_.names.empty() ? "" : column.header};
      if (!column.other_unit.empty())
        return fail_at(layout_.header, "found two units of the " + std::string(kRoleNames[role]) +
                                           quoted_name(number_[role]) + ": " + std::string(column.parts.unit->name) +
                                           " in the name and " + column.other_unit +
                                           " in the row of units, expected one; correct the header");
      if (number_[role] < columns_.size() && columns_[number_[role]].is_units) unit_column_[role] = number_[role] + 1;
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
    for (const Unit& given : request_.units)
      if (given.quantity == static_cast<Quantity>(role)) return given;
    return std::nullopt;
  }

  Status find_unit_of(std::size_t role) {
    constexpr const char* kQuantities[] = {"time", "length", "force"};
    const auto quantity = static_cast<Quantity>(role);
    const std::size_t number = number_[role];
    const NameAndUnit& parts = columns_[number - 1].parts;
    const std::string in_header = parts.unit ? std::string(parts.unit->name) : printable(parts.foreign_unit);
    const auto given = given_unit(role);
    std::optional<Unit> unit = given ? given : parts.unit;
    const bool fits = unit && unit->quantity == quantity;
    const double volts = role == 2 ? volts_of(parts.foreign_unit) : 0.0;
    const std::string the_role = "the " + std::string(kRoleNames[role]) + quoted_name(number);
    if (role == 2 && request_.gain_N_per_V && (fits || !unit)) {
      if (parts.unit)
        note("warning: " + the_role + " is read in V as --gain says, although its header says " + in_header);
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
        return fail("found the unit " + name + " in the rows of " + the_role + ", expected " +
                    (one->quantity != quantity
                         ? std::string("a unit of ") + kQuantities[role]
                         : std::string(unit->name) + ", as " + (given ? "--units" : "the header") + " says") +
                    "; correct the one that is wrong");
    }
    if (!units.empty()) {
      const bool same = std::ranges::all_of(units, [&](const auto& one) { return one == units.front(); });
      use_unit(role, same ? units.front() : "each row's unit", same ? find_unit(units.front())->to_si : 0.0);
      return {};
    }
    if (fits) {
      // A note where the unit of the user contradicts that of the header.
      if (parts.unit ? parts.unit->to_si != unit->to_si : !in_header.empty())
        note("warning: " + the_role + " is read in " + std::string(unit->name) +
             " as --units says, although its header says " + in_header);
      use_unit(role, unit->name, unit->to_si);
      return {};
    }
    if (!parts.foreign_unit.empty() || (unit && role > 0))
      return fail_at(layout_.header, "found the unit \"" + in_header + "\" in column " + std::to_string(number) +
                                         quoted_name(number) + ", expected a unit of " + kQuantities[role] + " (" +
                                         unit_names(quantity) +
                                         "); convert the column, choose another with --columns " + kRoleNames[role] +
                                         "=NAME, or give the unit of the numbers with --units");
    return fail("found no unit of " + the_role + ", expected one of " + unit_names(quantity) +
                "; add the unit of the numbers: --units " + (role == 1 ? "mm" : "N") +
                ", with a comma between two units: --units mm,N");
  }

  Status find_time_unit() {
    const Status understood = times_.examine(cells_of(number_[0]), layout_.decimal);
    if (!understood) return fail_at(block_.begin + 1, understood.error().message);
    if (fraction_ > 0 && number_[0] + 1 == fraction_) {
      times_.add_fractions(fraction_unit_s(columns_[fraction_ - 1]));
      use_unit(0, times_.are_of_a_clock() ? "clock" : "s", 1.0);
      return {};
    }
    if (times_.are_of_a_clock()) {
      use_unit(0, "clock", 1.0);
      return {};
    }
    const auto& parts = columns_[number_[0] - 1].parts;
    if (given_unit(0) || !parts.foreign_unit.empty() || (parts.unit && parts.unit->quantity == Quantity::time))
      return find_unit_of(0);
    // Every unit in which the rate of the rows is possible, and that of a date, if the first time is one in one unit.
    std::vector<Reading> possible, dated;
    const double step = times_.median_step();
    for (const char* name : {"ns", "ticks", "us", "ms", "s", "min", "h", "days"}) {
      const double to_s = find_unit(name)->to_si, rate_Hz = 1.0 / (step * to_s);
      if (!(step > 0.0) || !rate_in_range(step * to_s)) continue;
      const bool common = std::string_view("ns us ms s").find(name) != std::string_view::npos;
      // The rate of a rare unit is a set one, unless the times are rounded or jitter.
      const bool steady = std::abs(times_.mean_step() / step - 1.0) < 1e-3;
      if (!common && steady && !is_round(rate_Hz)) continue;
      possible.push_back({std::string("--units ") + name, short_number(rate_Hz) + " Hz"});
      if (is_date(name, times_.first_cell() * to_s)) dated.push_back(possible.back());
    }
    if (dated.size() == 1) possible = dated;
    const std::string steps = " and steps of " + short_number(step);
    if (possible.size() != 1)
      return fail("found no unit of the time" + quoted_name(number_[0]) + steps + ", expected one of " +
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

  // The value of a role in the present row, in SI; none if it cannot be read.
  std::optional<double> value_of(std::size_t role) const {
    const auto cell = parse_table_cell(field(number_[role]), layout_.decimal);
    if (!cell) return std::nullopt;
    std::optional<Unit> unit = cell->unit;
    if (unit_column_[role] > 0) unit = find_unit(field(unit_column_[role]));
    if (unit && unit->quantity != static_cast<Quantity>(role)) return std::nullopt;
    const double to_si = unit ? unit->to_si : to_si_[role];
    return to_si != 0.0 ? std::optional(to_si * cell->value) : std::nullopt;
  }

  // Reads every line of the block. Lines that cannot be read keep their place in time.
  Status read_rows() {
    std::array<std::uint64_t, kRoles> missing{};
    std::uint64_t bad = 0;
    std::optional<Error> fault;
    // Without a clock every line is a row in time, also an empty one, unless each row has an empty line after it.
    const bool no_clock = number_[0] == 0 || request_.rate_Hz;
    const auto empty = std::count_if(lines_.begin() + static_cast<std::ptrdiff_t>(block_.begin),
                                     lines_.begin() + static_cast<std::ptrdiff_t>(block_.end),
                                     [](std::string_view line) { return trimmed(line).empty(); });
    const bool empty_counts = no_clock && static_cast<std::size_t>(empty) + 1 < block_.rows;
    for (std::size_t i = block_.begin; i < block_.end; ++i) {
      const std::string_view line = lines_[i];
      if (trimmed(line).empty() && !empty_counts) continue;
      if (line.starts_with('#')) {
        leave_out("comments", i + 1);
        continue;
      }
      const bool in_time = is_row(layout_, line, fields_);
      Row row{{}, i + 1};
      const auto position_m = value_of(1), force_N = value_of(2);
      row.row.position_m = position_m.value_or(0.0);
      row.row.force_N = force_N.value_or(0.0);
      if (number_[0] > 0) {
        const auto time = times_.since_first(field(number_[0]), field(fraction_));
        if (time) row.own_s = to_si_[0] * *time;
      }
      for (const auto& [number, column] : {std::pair{velocity_, &RecordingRow::velocity_m_per_s},
                                           std::pair{acceleration_, &RecordingRow::acceleration_m_per_s2}})
        if (number > 0 && !parse_table_number(field(number), layout_.decimal, row.row.*column)) gaps_ = true;
      const bool needs_time = number_[0] > 0 && !request_.rate_Hz;
      row.good = in_time && position_m && force_N && (row.own_s || !needs_time);
      if (!row.good) {
        for (const std::size_t role : {1u, 2u})
          if (in_time && is_empty(number_[role])) ++missing[role];
        leave_out(in_time ? "unreadable" : "text between the rows", i + 1);
        if (bad++ == 0) fault = unreadable(i + 1, line, !position_m ? number_[1] : !force_N ? number_[2] : number_[0]);
      }
      if (in_time || row.good || no_clock) rows_.push_back(row);
    }
    for (std::size_t i = block_.end; i < lines_.size() && !is_row(layout_, lines_[i], fields_); ++i)
      if (!trimmed(lines_[i]).empty() && layout_.blocks.size() == 1) leave_out("text after the table", i + 1);
    const auto good = static_cast<std::uint64_t>(std::ranges::count(rows_, true, &Row::good));
    const std::uint64_t most = std::max(missing[1], missing[2]);
    const bool slow = most >= kSlowRows && 2 * most >= bad;
    const std::string full = std::to_string(good) + " full rows";
    if (slow && (bad > request_.skip_bad_rows || good == 0)) {
      if (has_two_clocks()) return {};
      const std::size_t role = missing[1] > missing[2] ? 1 : 2;
      return fail("found no value of the " + std::string(kRoleNames[role]) + " in column " +
                      std::to_string(number_[role]) + quoted_name(number_[role]) + " in " +
                      std::to_string(missing[role]) + " of " + std::to_string(good + bad) + " rows, expected one in " +
                      "every row; " +
                      (good == 0 ? "no row has both position and force: resample both to common times"
                                 : "use only the " + full + ", or fill the empty fields by interpolation"),
                  good == 0 ? std::vector<Reading>{}
                            : std::vector<Reading>{{"--skip-bad-rows " + std::to_string(bad), "the " + full}});
    }
    if (bad > request_.skip_bad_rows && !has_two_clocks())
      return refusal(path_, request_, fault->message,
                     {{"--skip-bad-rows " + std::to_string(bad),
                       "without " + count_of(bad, "such row") + "; the other rows keep their times"}});
    return {};
  }

  Error unreadable(std::uint64_t line, std::string_view text, std::size_t number) const {
    const std::string_view cell = field(number);
    const std::string found = cell.empty() ? "an empty field" : '"' + printable(cell) + '"';
    if (!is_row(layout_, text, const_cast<Fields&>(fields_)))
      return Error{":" + std::to_string(line) + ": found \"" + printable(text) + "\", expected a row of " +
                   count_of(layout_.fields, "field")};
    return Error{":" + std::to_string(line) + ": found " + found + " in column " + std::to_string(number) +
                 quoted_name(number) + ", expected a number; repair the value, or leave the row out"};
  }

  // Refuses times that go back, and clocks that contradict each other.
  Status check_times() {
    if (times_.midnights() > 0) note("the clock passes midnight: a day is added from there");
    std::vector<Reading> parts;
    LineRange part;
    double last_s = 0.0, most_s = 0.0;
    std::uint64_t first_back = 0;
    const double step_s = to_si_[0] * times_.median_step();
    for (const Row& row : rows_) {
      if (!row.own_s) continue;
      const double back_s = last_s - *row.own_s;
      if (part.first > 0 && back_s > 0.0) {
        if (first_back == 0) first_back = row.line;
        most_s = std::max(most_s, back_s);
        parts.push_back(reading_of(part, count_of(part.last - part.first + 1, "line")));
        part.first = 0;
      }
      if (part.first == 0) part.first = row.line;
      part.last = row.line;
      last_s = *row.own_s;
    }
    const bool restarts = most_s > kSwappedSteps * step_s;
    if (first_back > 0 && (restarts || !request_.rate_Hz)) {
      parts.push_back(reading_of(part, count_of(part.last - part.first + 1, "line")));
      const bool many = parts.size() > kMostReadings;
      if (many) parts.clear();
      for (const std::size_t other : other_times_)
        parts.insert(parts.begin(), {"--columns time=" + std::to_string(other),
                                     "the times of \"" + printable(columns_[other - 1].header) + '"'});
      const double rate_Hz = static_cast<double>(rows_.size() - 1) / std::max(last_s, step_s);
      if (!restarts) parts.insert(parts.begin(), {"--rate " + short_number(rate_Hz), "if the rows are evenly spaced"});
      return fail_at(first_back,
                     "found a time " + short_number(most_s) + " s before that of the row above" +
                         quoted_name(number_[0]) + ", expected later times in every row; " +
                         (many ? "sort the rows, or split the file" : "choose the rows"),
                     parts);
    }
    return has_two_clocks() ? Status() : compare_clocks();
  }

  // The times of another column, in seconds since its first one, which is put into `first_s`; empty without a known
  // unit.
  std::vector<double> times_of(std::size_t number, bool& whole, double& first_s) const {
    const Fields cells = cells_of(number);
    RowTimes times;
    if (!times.examine(cells, layout_.decimal)) return {};
    const auto& unit = columns_[number - 1].parts.unit;
    const double to_s = times.are_of_a_clock()                     ? 1.0
                        : unit && unit->quantity == Quantity::time ? unit->to_si
                                                                   : to_si_[0];
    whole = times.are_of_a_clock() && times.are_whole_seconds();
    first_s = to_s * times.first_cell();
    std::vector<double> seconds;
    for (const std::string_view cell : cells) {
      const auto time = times.since_first(cell);
      seconds.push_back(time ? to_s * *time : std::nan(""));
    }
    return seconds;
  }

  Status compare_clocks() {
    if (number_[0] == 0 || rows_.empty() || !rows_.front().own_s || !rows_.back().own_s) return {};
    std::vector<std::size_t> others = other_times_;
    for (std::size_t i = 0; i < columns_.size(); ++i)
      if (columns_[i].is_clock && i + 1 != number_[0] && std::ranges::find(others, i + 1) == others.end() &&
          columns_[i].values.front().find(':') != std::string::npos)
        others.push_back(i + 1);
    const double step_s = to_si_[0] * times_.median_step();
    for (const std::size_t other : others) {
      bool whole = false;
      double first_s = 0.0;
      const std::vector<double> seconds = times_of(other, whole, first_s);
      if (seconds.size() != rows_.size()) continue;
      // A clock with hours and minutes may be that of the arrival; its duration must be that of the times.
      const bool rival = !columns_[other - 1].is_clock || times_.are_of_a_clock();
      double apart_s = 0.0;
      for (std::size_t i = 0; i < rows_.size(); ++i)
        if (rows_[i].own_s && std::isfinite(seconds[i]))
          apart_s = std::max(apart_s, std::abs(*rows_[i].own_s - seconds[i]));
      const double limit_s =
          std::max(rival ? 0.5 * step_s : kDuration_s, kDurationShare * (rival ? 0.0 : *rows_.back().own_s));
      if (apart_s <= limit_s + (whole ? 1.0 : 0.0) || has_given_time()) continue;
      std::vector<Reading> readings;
      for (const std::size_t number : {number_[0], other})
        readings.push_back({"--columns time=" + std::to_string(number),
                            '"' + printable(columns_[number - 1].header) +
                                "\": " + short_number(number == other ? seconds.back() : *rows_.back().own_s) + " s"});
      return fail("found two clocks that differ by up to " + short_number(apart_s) + " s, in columns " +
                      std::to_string(number_[0]) + quoted_name(number_[0]) + " and " + std::to_string(other) +
                      quoted_name(other) + ", expected one; choose the time",
                  readings);
    }
    return {};
  }
  bool has_given_time() const { return !request_.columns[0].empty(); }

  // Two clocks: intervals of LabVIEW that differ, or a column of times before each channel.
  bool has_two_clocks() const {
    if (request_.rate_Hz) return false;
    const auto& steps = layout_.steps_s;
    if (!steps.empty()) return lab(steps, 1) != lab(steps, 2) || lab(layout_.starts_s, 1) != lab(layout_.starts_s, 2);
    const auto clocks = clock_columns();
    if (clocks[1] == clocks[2]) return false;
    return cells_of(clocks[1]) != cells_of(clocks[2]);
  }
  double lab(const std::vector<double>& values, std::size_t role) const {
    return number_[role] <= values.size() ? values[number_[role] - 1] : 0.0;
  }
  // The column of times that is the nearest before each channel.
  std::array<std::size_t, kRoles> clock_columns() const {
    std::array<std::size_t, kRoles> clocks{number_[0], 0, 0};
    std::vector<std::size_t> times = other_times_;
    if (number_[0] > 0) times.push_back(number_[0]);
    std::ranges::sort(times);
    for (const std::size_t role : {1u, 2u})
      for (const std::size_t time : times)
        if (time < number_[role]) clocks[role] = time;
    if (clocks[1] == 0 || clocks[2] == 0) clocks[1] = clocks[2] = number_[0];
    return clocks;
  }

  // Two channels with clocks of their own, on the times of the faster one.
  Status resample() {
    std::array<Channel, kRoles> channels;
    const auto clocks = clock_columns();
    for (const std::size_t role : {1u, 2u}) {
      bool whole = false;
      double first_s = lab(layout_.starts_s, role);
      std::vector<double> seconds;
      if (layout_.steps_s.empty()) seconds = times_of(clocks[role], whole, first_s);
      Channel& channel = channels[role];
      std::size_t place = 0;
      for (std::size_t line = block_.begin; line < block_.end; ++line) {
        if (!is_row(layout_, lines_[line], fields_)) continue;
        const double since_s =
            layout_.steps_s.empty() ? seconds[place] : static_cast<double>(place) * lab(layout_.steps_s, role);
        ++place;
        const auto value = value_of(role);
        if (!value || !std::isfinite(since_s)) continue;
        if (!channel.times_s.empty() && !(first_s + since_s > channel.times_s.back()))
          return fail_at(line + 1, "found a time of the " + std::string(kRoleNames[role]) +
                                       " that is not later than that above, expected later times in every row");
        channel.times_s.push_back(first_s + since_s);
        channel.values.push_back(*value);
        channel.lines.push_back(line + 1);
      }
      if (channel.values.size() < 2) return fail("found no values of the " + std::string(kRoleNames[role]));
    }
    const std::size_t slow = channels[1].step_s() >= channels[2].step_s() ? 1 : 2, fast = 3 - slow;
    const std::string slow_name = kRoleNames[slow], fast_name = kRoleNames[fast];
    const double begin_s = std::min(channels[1].times_s.front(), channels[2].times_s.front());
    const auto words = [&](std::size_t role) {
      return std::string(kRoleNames[role]) + " every " + short_number(channels[role].step_s()) + " s from " +
             short_number(channels[role].times_s.front() - begin_s) + " s on";
    };
    const std::string found = "found two clocks, with a " + words(1) + " and a " + words(2);
    std::vector<RecordingRow>& rows = table_.recording.rows;
    table_.left_out.clear();
    std::size_t after = 1;
    double error = 0.0;
    const Channel &own = channels[fast], &other = channels[slow];
    for (std::size_t i = 0; i < own.values.size(); ++i) {
      const double time_s = own.times_s[i];
      if (time_s < other.times_s.front() - 1e-9 || time_s > other.times_s.back() + 1e-9) {
        leave_out(slow == 1 ? "without a position at the time" : "without a force at the time", own.lines[i]);
        continue;
      }
      const double between = other.at(time_s, after, error);
      rows.push_back({time_s - begin_s, slow == 1 ? between : own.values[i], slow == 1 ? own.values[i] : between});
    }
    const auto [low, high] = std::ranges::minmax(other.values);
    if (error > kInterpolationShare * (high - low))
      return fail(found + ", expected one, or a " + slow_name +
                  " that is fast enough to be interpolated; export both channels with one interval");
    note("warning: " + found + ": the " + slow_name + " is interpolated at the times of the " + fast_name);
    table_.columns[0] = {clocks[fast],
                         layout_.names.empty() || clocks[fast] == 0 ? "" : columns_[clocks[fast] - 1].header,
                         std::string(table_.columns[0].unit)};
    return {};
  }

  // The place of each row in time by a column that counts the rows and skips some; empty: there is none.
  std::vector<double> counted_places() {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const ForeignColumn& column = columns_[i];
      if (!column.is_whole || column.changes + 1 < rows_.size() || std::ranges::count(number_, i + 1) > 0) continue;
      std::vector<double> places, steps;
      double value = 0.0;
      for (const std::string_view cell : cells_of(i + 1))
        if (parse_table_number(cell, layout_.decimal, value)) places.push_back(value);
      for (std::size_t k = 1; k < places.size(); ++k) steps.push_back(places[k] - places[k - 1]);
      if (places.size() != rows_.size() || steps.size() < kSlowRows) continue;
      const double step = nth_smallest(steps, steps.size() / 2), first = places.front();
      double gaps = 0.0;
      const bool counts = step > 0.0 && std::ranges::all_of(steps, [&](double one) {
                            gaps += one / step - 1.0;
                            return one >= step && std::fmod(one, step) == 0.0;
                          });
      if (!counts || gaps == 0.0) continue;
      for (double& place : places) place = (place - first) / step;
      note("warning: column " + std::to_string(i + 1) + quoted_name(i + 1) + " counts the rows and skips " +
           short_number(gaps) + " of them: the others keep their times");
      return places;
    }
    return {};
  }

  // Gives every row its time.
  Status set_times() {
    table_.lines = {rows_.front().line, rows_.back().line};
    if (has_two_clocks()) return resample();
    double rate_Hz = request_.rate_Hz.value_or(0.0);
    if (rate_Hz == 0.0 && !layout_.steps_s.empty() && lab(layout_.steps_s, 1) > 0.0) {
      rate_Hz = 1.0 / lab(layout_.steps_s, 1);
      number_[0] = 0;
      note("the rows are evenly spaced by the Delta_X above the table");
    } else if (rate_Hz > 0.0) {
      note("the rows are evenly spaced at the --rate of " + short_number(rate_Hz) + " Hz");
    }
    const double own_s = rows_.back().own_s.value_or(0.0);
    const bool copies_left = rate_Hz == 0.0;
    if (copies_left) {
      // Rows that share a time are evenly spaced if the clock is coarse.
      std::vector<RecordingRow> all;
      for (const Row& row : rows_) {
        all.push_back(row.row);
        all.back().time_s = row.own_s.value_or(all.size() > 1 ? all[all.size() - 2].time_s : 0.0);
      }
      const RepeatedTimes repeated = find_repeated_times(all);
      const std::string shared = std::to_string(repeated.rows) + " of " + std::to_string(rows_.size()) + " rows";
      if (repeated.rate_Hz && !repeated.copies) {
        rate_Hz = *repeated.rate_Hz;
        note("warning: the clock" + quoted_name(number_[0]) + " has steps of " + short_number(repeated.step_s) +
             " s, and " + shared +
             " have the time of the row above: the rows are taken as evenly spaced, as with --rate " +
             short_number(rate_Hz));
      } else if (!repeated.copies && 2 * repeated.rows > all.size()) {
        const std::string rate = short_number(repeated.mean_rate_Hz);
        return fail("found the time of the row above" + quoted_name(number_[0]) + " in " + shared +
                        ", expected a later time in every row; write the times with more digits, or, if the rows are "
                        "evenly spaced, add --rate HZ",
                    repeated.mean_rate_Hz > 0.0 ? std::vector<Reading>{{"--rate " + rate, "the mean rate"}}
                                                : std::vector<Reading>{});
      }
    }
    auto& rows = table_.recording.rows;
    const std::vector<double> places = !copies_left ? counted_places() : std::vector<double>{};
    for (std::size_t place = 0; place < rows_.size(); ++place) {
      RecordingRow row = rows_[place].row;
      const double at = places.empty() ? static_cast<double>(place) : places[place];
      row.time_s = rate_Hz > 0.0 ? at / rate_Hz : rows_[place].own_s.value_or(0.0);
      if (!rows_[place].good) continue;
      if (!rows.empty() && row.time_s == rows.back().time_s) {
        leave_out("with the time of the row above", rows_[place].line);
        continue;
      }
      rows.push_back(row);
    }
    if (rows.empty()) return {};
    const double seconds = rows.back().time_s;
    if (request_.rate_Hz && number_[0] > 0 && std::abs(seconds - own_s) > kDurationShare * own_s && own_s > 0.0)
      note("warning: with --rate " + short_number(rate_Hz) + " the recording is " + short_number(seconds) +
           " s long, but " + short_number(own_s) + " s by the times in the file");
    if (rate_Hz == 0.0 && times_.are_of_a_clock())
      note(times_.have_dates() ? "the times are dates: time_s is 0 at the first row"
                               : "the times are times of day: time_s is 0 at the first row");
    return {};
  }

  // Applies the signs, and checks what does not depend on a moved zero.
  Status finish() {
    auto& recording = table_.recording;
    auto& rows = recording.rows;
    for (RecordingRow& row : rows) {
      if (request_.flip_position) {
        row.position_m = -row.position_m;
        row.velocity_m_per_s = -row.velocity_m_per_s;
        row.acceleration_m_per_s2 = -row.acceleration_m_per_s2;
      }
      if (request_.flip_force) row.force_N = -row.force_N;
    }
    RowRules rules;
    for (const RecordingRow& row : rows)
      if (const auto fault = rules.check({row.time_s, 0.0, 0.0})) return fail_at(table_.lines.first, fault->text);
    if (const auto fault = rules.finish()) return fail(fault->text);
    recording.columns = {velocity_ > 0 && !gaps_, acceleration_ > 0 && !gaps_};
    const auto used = [&](std::size_t role) { return number_[role] > 0; };
    if (!used(0) || request_.rate_Hz) table_.columns[0] = {};
    table_.delimiter = layout_.delimiter.name;
    table_.decimal = layout_.decimal == ',' ? "comma" : "point";
    table_.header_line = layout_.header;
    recording.name = printable(std::filesystem::path(path_).stem().string(), std::string::npos);
    if (has_arrivals_ && number_[0] != 1) note("the times of arrival before each line are not used");
    return {};
  }

  const std::string& path_;
  const ImportRequest& request_;
  std::vector<std::string_view> lines_;
  bool has_arrivals_ = false;
  ImportedTable table_;
  TableLayout layout_;
  RowBlock block_;
  std::size_t end_of_block_ = 0;
  std::vector<ForeignColumn> columns_;
  std::array<std::size_t, kRoles> number_{}, unit_column_{};  // from 1; 0: none
  std::array<double, kRoles> to_si_{};
  std::vector<std::size_t> other_times_;
  std::size_t fraction_ = 0, velocity_ = 0, acceleration_ = 0;
  RowTimes times_;
  Fields fields_;  // of the present row
  bool gaps_ = false;
  std::vector<Row> rows_;
};

}  // namespace

Result<ImportedTable> import_table(const std::string& path, const ImportRequest& request) {
  const auto text = read_foreign_text(path);
  if (!text) return text.error();
  return Importer(*text, path, request).run();
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
