#include "engine/import/import_table.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "engine/base/csv_scanner.h"
#include "engine/import/import_words.h"
#include "engine/import/row_times.h"
#include "engine/import/table_number.h"
#include "engine/recording/recording_rules.h"

namespace palpate {
namespace {

// The first rows determine which columns are constant, and the unit of time.
constexpr std::size_t kFirstRows = 200;
constexpr double kVelocitySlope = 0.2;
constexpr auto kNoColumn = static_cast<std::size_t>(-1);

class Importer {
 public:
  Importer(const ForeignText& foreign, std::string label, const ImportRequest& request)
      : text_(foreign.text), label_(std::move(label)), request_(request) {
    table_.encoding = foreign.encoding;
  }

  Result<ImportedTable> run();

 private:
  Error fail(const std::string& text) const { return Error{label_ + ": " + text}; }
  Error fail_at(std::uint64_t line, const std::string& text) const {
    return Error{label_ + ":" + std::to_string(line) + ": " + text};
  }
  // The quoted name for a message, such as ' "Weg [mm]"'; empty without a header.
  std::string quoted_name(std::size_t role) const {
    if (table_.layout.names.empty()) return {};
    return std::string(" \"").append(printable(header_[index_[role]].header)).append("\"");
  }
  void note(const std::string& sentence) { table_.notes.push_back(sentence); }

  void read_labview_head();
  Status find_columns();
  Status find_unit_of(std::size_t role);
  Status find_time_unit();
  void split(std::string_view line);
  bool parse_row(std::string_view line, TableTime& time, RecordingRow& row);
  bool is_bad_row(std::string_view line);
  Error explain_row(std::string_view line, std::uint64_t number);
  Result<bool> add_time(const TableTime& time, std::uint64_t line, RecordingRow& row);
  void use_unit(std::size_t role, const Unit& unit);
  void check_rate();
  void check_velocity();
  Status read_rows();
  void describe_time();

  std::string_view text_;
  std::string label_;
  ImportRequest request_;
  ImportedTable table_;
  std::vector<ForeignColumn> header_;
  std::vector<std::vector<std::string_view>> first_rows_;  // their fields
  std::array<std::size_t, kRoles> index_{};
  std::array<double, kRoles> to_si_{1.0, 1.0, 1.0};
  std::vector<std::string_view> row_;
  std::array<std::string_view, kRoles> fields_;
  RowTimes times_{'.'};
  std::uint64_t repeated_ = 0;
  bool own_time_ = false;     // the file has times besides a given rate
  double own_seconds_ = 0.0;  // by these times
  std::optional<VelocityColumn> velocity_;
};

// The unit of `quantity`: that of the user, otherwise that of the header.
std::optional<Unit> unit_of(Quantity quantity, const ImportRequest& request, const ForeignColumn& column) {
  for (const Unit& unit : request.units) {
    if (unit.quantity == quantity) return unit;
  }
  return column.parts.unit;
}

// Text files of LabVIEW have the units of the columns above the table and, if the table has no times, the interval of
// the rows.
void Importer::read_labview_head() {
  std::string_view head = text_.substr(0, table_.layout.data_offset);
  std::vector<std::string_view> fields;
  std::string_view step;
  bool times = true;
  while (!head.empty()) {
    split_table_fields(next_line(head), table_.layout.delimiter, fields);
    if (fields.size() < 2) continue;
    if (fields[0] == "Y_Unit_Label") table_.layout.units = fields;
    if (fields[0] == "X_Columns") times = fields[1] != "No";
    if (fields[0] == "Delta_X") step = fields[1];
  }
  double step_s = 0.0;
  const bool even = !times && parse_table_number(step, table_.layout.decimal, step_s) && step_s > 0.0;
  if (!even || request_.rate_Hz) return;
  request_.rate_Hz = 1.0 / step_s;
  note("the rows are evenly spaced by the Delta_X above the table");
}

Status Importer::find_columns() {
  const TableLayout& layout = table_.layout;
  std::string_view rest = text_.substr(layout.data_offset);
  while (first_rows_.size() < kFirstRows && !rest.empty()) {
    split_table_fields(next_line(rest), layout.delimiter, first_rows_.emplace_back());
  }
  const auto& first_row = first_rows_.front();
  const bool has_header = !layout.names.empty();
  for (std::size_t i = 0; i < layout.columns; ++i) {
    ForeignColumn column;
    const std::string_view name = has_header ? layout.names[i] : i < first_row.size() ? first_row[i] : "";
    column.header = name;
    if (has_header) column.parts = split_name_and_unit(column.header);
    if (!layout.units.empty() && i < layout.units.size()) {
      if (const auto unit = find_unit(layout.units[i])) column.parts.unit = unit;
    }
    const auto changes = [&](const auto& row) {
      return i < std::min(row.size(), first_row.size()) && row[i] != first_row[i];
    };
    column.constant = first_rows_.size() > 1 && std::none_of(first_rows_.begin(), first_rows_.end(), changes);
    header_.push_back(std::move(column));
  }
  auto choice = choose_columns(header_, request_.columns, has_header, true);
  // With a given rate the times of the file are only compared with it.
  if (request_.rate_Hz && !choice) choice = choose_columns(header_, request_.columns, has_header, false);
  if (!choice) return fail(choice.error().message);
  velocity_ = has_header ? find_velocity(header_) : std::nullopt;
  for (std::size_t role = 0; role < kRoles; ++role) {
    index_[role] = choice->column[role].value_or(kNoColumn);
    if (!choice->column[role] || (role == 0 && request_.rate_Hz)) continue;
    table_.columns[role] = {index_[role] + 1, has_header ? header_[index_[role]].header : "", "",
                            choice->guessed[role]};
  }
  return {};
}

void Importer::use_unit(std::size_t role, const Unit& unit) {
  if (role == 0) {
    times_.use_unit(unit.to_si);
  } else {
    to_si_[role] = unit.to_si;
  }
  table_.columns[role].unit = unit.name;
}

// Finds the unit of position or force.
Status Importer::find_unit_of(std::size_t role) {
  const Quantity quantity = static_cast<Quantity>(role);
  const auto& column = header_[index_[role]];
  const std::optional<Unit> unit = unit_of(quantity, request_, column);
  if (unit && unit->quantity != quantity) {
    return fail("found the unit " + std::string(unit->name) + " in the column \"" + printable(column.header) +
                "\", expected one of a " + (role == 1 ? "length" : "force") + " for the " + kRoleNames[role] +
                "; choose another with --columns " + kRoleNames[role] + "=NAME; the columns are " +
                list_columns(header_));
  }
  const double volts = role == 2 ? volts_of(column.parts.foreign_unit) : 0.0;
  if (role == 2 && request_.gain_N_per_V) {
    to_si_[role] = (volts > 0.0 ? volts : 1.0) * *request_.gain_N_per_V;
    table_.columns[role].unit = "V";
    return {};
  }
  if (volts > 0.0) {
    return fail("found volts in the column \"" + printable(column.header) +
                "\", expected a force; say how many newtons a volt is: --gain N_PER_V");
  }
  if (!unit) {
    return fail("found no unit of the " + std::string(kRoleNames[role]) + quoted_name(role) + "; add --units " +
                (role == 1 ? "mm (or m, cm, um, inch)" : "N (or mN, kN, g, kg, lbf)") +
                ", with a comma between two units: --units mm,N");
  }
  use_unit(role, *unit);
  return {};
}

// The times are those of a clock, have a unit from the header or the user, or are in the only unit with a valid rate.
Status Importer::find_time_unit() {
  const std::size_t index = index_[0];
  std::vector<std::string_view> fields;
  for (const auto& row : first_rows_) fields.push_back(index < row.size() ? row[index] : std::string_view());
  times_ = RowTimes(table_.layout.decimal);
  const double step = times_.examine(fields);
  if (times_.are_of_a_clock()) {
    table_.columns[0].unit = "clock";
    return {};
  }
  if (const auto unit = unit_of(Quantity::time, request_, header_[index]); unit && unit->quantity == Quantity::time) {
    use_unit(0, *unit);
    return {};
  }
  std::vector<Unit> possible;
  for (const char* name : {"s", "ms", "us", "ns"}) {
    const Unit candidate = *find_unit(name);
    if (step > 0.0 && rate_in_range(step * candidate.to_si)) possible.push_back(candidate);
  }
  if (possible.size() != 1) {
    const std::string choices = possible.empty()
                                    ? "s, ms, us or ns"
                                    : std::string(possible[0].name) + " or --units " + std::string(possible[1].name);
    return fail("found no unit of the time" + quoted_name(0) + " and steps of " + short_number(step) +
                "; add --units " + choices + ", or --rate HZ if the rows are evenly spaced");
  }
  use_unit(0, possible.front());
  note("the header has no unit of time: taken as " + table_.columns[0].unit + ", the only unit in which steps of " +
       short_number(step) + " are a rate of 10 Hz to 20 kHz");
  return {};
}

// Splits off the fields of the roles, empty where they are missing.
void Importer::split(std::string_view line) {
  split_table_fields(line, table_.layout.delimiter, row_);
  for (std::size_t i = 0; i < kRoles; ++i) fields_[i] = index_[i] < row_.size() ? row_[index_[i]] : std::string_view();
}

bool Importer::parse_row(std::string_view line, TableTime& time, RecordingRow& row) {
  split(line);
  if (!request_.rate_Hz && !times_.parse(fields_[0], time)) return false;
  const char decimal = table_.layout.decimal;
  if (!parse_table_number(fields_[1], decimal, row.position_m) ||
      !parse_table_number(fields_[2], decimal, row.force_N)) {
    return false;
  }
  if (velocity_) {
    const auto field = velocity_->column < row_.size() ? row_[velocity_->column] : std::string_view();
    if (!parse_table_number(field, decimal, row.velocity_m_per_s)) return false;
    row.velocity_m_per_s *= velocity_->to_si;
  }
  row.position_m *= to_si_[1];
  row.force_N *= to_si_[2];
  return true;
}

// Whether a line is a damaged row: the fields of its numbers contain digits.
bool Importer::is_bad_row(std::string_view line) {
  split(line);
  constexpr const char* kDigits = "0123456789";
  return fields_[1].find_first_of(kDigits) < fields_[1].size() && fields_[2].find_first_of(kDigits) < fields_[2].size();
}

// The error of a row that could not be read.
Error Importer::explain_row(std::string_view line, std::uint64_t number) {
  split(line);
  for (std::size_t role = 0; role < kRoles; ++role) {
    if (index_[role] == kNoColumn || (role == 0 && request_.rate_Hz)) continue;
    TableTime time;
    double value = 0.0;
    const bool good =
        role == 0 ? times_.parse(fields_[0], time) : parse_table_number(fields_[role], table_.layout.decimal, value);
    if (good) continue;
    const std::string_view field = trimmed(fields_[role]);
    const std::string found =
        field.empty() ? "an empty field" : std::string("\"").append(printable(field)).append("\"");
    return fail_at(number, "found " + found + " in column " + std::to_string(index_[role] + 1) + quoted_name(role) +
                               ", expected the " + kRoleNames[role] +
                               "; remove the row, repair the value, or leave up to N such rows out: --skip-bad-rows N");
  }
  return fail_at(number, "found no number in column " + std::to_string(velocity_ ? velocity_->column + 1 : 1) +
                             ", the velocity; remove the row or repair the value");
}

// Sets the time of a row. Returns false if it repeats the last one.
Result<bool> Importer::add_time(const TableTime& time, std::uint64_t line, RecordingRow& row) {
  if (request_.rate_Hz) {
    row.time_s = static_cast<double>(table_.recording.rows.size()) / *request_.rate_Hz;
    return true;
  }
  const double last_s = times_.last_s();
  const RowTimes::Step step = times_.add(time);
  row.time_s = times_.seconds(time);
  if (step == RowTimes::Step::repeated) ++repeated_;
  if (step == RowTimes::Step::after_midnight) {
    note("the clock passes midnight in line " + std::to_string(line) + ": a day is added from there");
  }
  if (step == RowTimes::Step::backward) {
    return fail_at(line, time_fault_words(quoted_name(0), row.time_s, last_s, table_.recording.rows.size()));
  }
  return step != RowTimes::Step::repeated;
}

// Reads every row in one pass. Other lines are allowed at the end only, except for the number of bad rows that the
// request allows.
Status Importer::read_rows() {
  std::string_view rest = text_.substr(table_.layout.data_offset);
  auto& rows = table_.recording.rows;
  std::uint64_t number = table_.layout.data_line - 1;
  std::uint64_t comments = 0;
  std::uint64_t footer_line = 0;
  std::string_view footer;
  std::uint64_t footer_lines = 0;
  std::uint64_t bad_rows = 0;
  if (!request_.rate_Hz) table_.columns[0].number = index_[0] + 1;
  while (!rest.empty()) {
    const std::string_view line = next_line(rest);
    ++number;
    TableTime time;
    RecordingRow row;
    if (!parse_row(line, time, row)) {
      const std::string_view bare = trimmed(line);
      if (bare.empty()) continue;
      if (bare.starts_with('#')) {
        ++comments;
        continue;
      }
      if (is_bad_row(line)) {
        if (++bad_rows > request_.skip_bad_rows) return explain_row(line, number);
        continue;
      }
      if (footer_line == 0) {
        footer_line = number;
        footer = line;
      }
      ++footer_lines;
      continue;
    }
    // Lines that are followed by rows are no footer.
    bad_rows += std::exchange(footer_lines, 0);
    if (footer_line > 0 && bad_rows > request_.skip_bad_rows) return explain_row(footer, footer_line);
    footer_line = 0;
    if (request_.flip_position) {
      row.position_m = -row.position_m;
      row.velocity_m_per_s = -row.velocity_m_per_s;
    }
    if (request_.flip_force) row.force_N = -row.force_N;
    const bool position_fits = std::abs(row.position_m) <= kMaximumPosition_m;
    if (!position_fits || !(std::abs(row.force_N) <= kMaximumForce_N)) {
      const std::size_t role = position_fits ? 2 : 1;
      return fail_at(number, size_fault_words(row, table_.columns[role], role, quoted_name(role)));
    }
    const auto added = add_time(time, number, row);
    if (!added) return added.error();
    if (*added) rows.push_back(row);
    if (own_time_ && times_.parse(fields_[0], time)) {
      times_.add(time);
      own_seconds_ = times_.seconds(time);
    }
  }
  if (comments > 0) note("left out " + count_of(comments, "comment line") + " between the rows");
  if (repeated_ > 0) note("left out " + count_of(repeated_, "row") + " with the time of the previous row");
  if (bad_rows > 0) note("left out " + count_of(bad_rows, "unreadable row"));
  if (footer_lines > 0) {
    note("left out " + count_of(footer_lines, "line") + " after the table, from line " + std::to_string(footer_line) +
         " \"" + printable(footer) + "\"");
  }
  return {};
}

void Importer::describe_time() {
  if (request_.rate_Hz)
    return note("the rows are evenly spaced at the --rate of " + short_number(*request_.rate_Hz) + " Hz");
  if (times_.are_of_a_clock())
    return note(times_.have_dates() ? "the times are dates: time_s is 0 at the first row"
                                    : "the times are times of day: time_s is 0 at the first row");
  const double start_s = times_.first_s();
  if (start_s != 0.0) note("the first time was " + short_number(start_s) + " s: time_s is 0 there");
}

// Warns if the given rate changes the duration.
void Importer::check_rate() {
  if (!own_time_) return;
  const double seconds = table_.recording.rows.back().time_s;
  if (std::abs(seconds - own_seconds_) <= kRateTolerance * own_seconds_) return;
  note("warning: with --rate " + short_number(*request_.rate_Hz) + " the recording is " + short_number(seconds) +
       " s long, but " + short_number(own_seconds_) + " s by the times in the file");
}

// Drops a velocity that is not the derivative of the position (unsigned, a set value): the slope of one over the other
// must be 1 within a fifth.
void Importer::check_velocity() {
  if (!velocity_) return;
  auto& rows = table_.recording.rows;
  double both = 0.0;
  double squares = 0.0;
  for (std::size_t i = 1; i + 1 < rows.size(); ++i) {
    const double rate = (rows[i + 1].position_m - rows[i - 1].position_m) / (rows[i + 1].time_s - rows[i - 1].time_s);
    both += rows[i].velocity_m_per_s * rate;
    squares += rows[i].velocity_m_per_s * rows[i].velocity_m_per_s;
  }
  const std::string column =
      "column " + std::to_string(velocity_->column + 1) + " \"" + printable(header_[velocity_->column].header) + "\"";
  table_.recording.columns.velocity = squares > 0.0 && std::abs(both / squares - 1.0) <= kVelocitySlope;
  if (table_.recording.columns.velocity) return note("the velocity is " + column);
  for (RecordingRow& row : rows) row.velocity_m_per_s = 0.0;
  note(column + " is not the derivative of the position: left out");
}

Result<ImportedTable> Importer::run() {
  auto layout = find_table_layout(text_, request_.decimal);
  if (!layout) return fail(layout.error().message);
  table_.layout = std::move(*layout);
  read_labview_head();
  if (const Status status = find_columns(); !status) return status.error();
  if (!request_.rate_Hz) {
    if (const Status status = find_time_unit(); !status) return status.error();
  } else if (index_[0] != kNoColumn) {
    const std::size_t notes = table_.notes.size();
    own_time_ = find_time_unit().ok();
    table_.notes.resize(notes);
    table_.columns[0] = {};
  }
  for (const std::size_t role : {1u, 2u}) {
    if (const Status status = find_unit_of(role); !status) return status.error();
  }
  if (const Status status = read_rows(); !status) return status.error();
  if (table_.recording.rows.size() < kRecordingMinimumRows) {
    return fail("found " + count_of(table_.recording.rows.size(), "row") + " of numbers, expected at least " +
                std::to_string(kRecordingMinimumRows) + "; record for longer");
  }
  describe_time();
  check_rate();
  check_velocity();
  table_.layout.names.clear();
  table_.layout.units.clear();
  table_.recording.name = std::filesystem::path(label_).stem().string();
  return std::move(table_);
}

}  // namespace

Result<ImportedTable> import_table(const std::string& path, const ImportRequest& request) {
  const auto text = read_foreign_text(path);
  if (!text) return text.error();
  return Importer(*text, path, request).run();
}

}  // namespace palpate
