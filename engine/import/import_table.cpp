#include "engine/import/import_table.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "engine/base/text.h"
#include "engine/import/table_cell.h"
#include "engine/recording/recording_rules.h"

namespace palpate {
namespace {

// The first rows determine which columns are constant, and the unit of time.
constexpr std::size_t kFirstRows = 200;
constexpr double kVelocitySlope = 0.2;

std::string short_number(double value) { return general(value, 6); }

// "3 rows"
std::string count_of(std::uint64_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

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
  // The quoted name of a column for a message, such as ' "Weg [mm]"'; empty without a header.
  std::string quoted_name(std::size_t index) const {
    return table_.layout.names.empty() ? "" : " \"" + printable(header_[index].header) + "\"";
  }
  void note(const std::string& sentence) { table_.notes.push_back(sentence); }
  void use_unit(std::size_t role, const Unit& unit) {
    to_si_[role] = unit.to_si;
    table_.columns[role].unit = unit.name;
  }
  // The index of the column of a role; beyond every row if there is none.
  std::size_t index_of(std::size_t role) const { return table_.columns[role].number - 1; }
  // The field of a column in the present row; empty if it is missing.
  std::string_view field(std::size_t index) const { return index < row_.size() ? row_[index] : std::string_view(); }

  Status find_columns();
  Status find_unit_of(std::size_t role);
  Status find_time_unit();
  std::optional<std::size_t> parse_row(RecordingRow& row);
  Error unreadable(std::size_t column, std::uint64_t line) const;
  Error broken(const RowFault& fault, std::uint64_t line) const;
  Status check_time(const RecordingRow& row, std::uint64_t line);
  Status read_rows();
  void describe_time();
  void check_velocity();

  std::string_view text_;
  std::string label_;
  ImportRequest request_;
  ImportedTable table_;
  std::vector<ForeignColumn> header_;
  std::vector<std::vector<std::string_view>> first_rows_;  // their fields
  std::array<double, kRoles> to_si_{1.0, 1.0, 1.0};
  std::vector<std::string_view> row_;  // the fields of the present row
  RowTimes times_{'.'};
  int midnights_ = 0;         // that a note names
  bool own_time_ = false;     // the file has times; with a given rate they are only compared with it
  double own_seconds_ = 0.0;  // the last of these times that could be read
  std::optional<VelocityColumn> velocity_;
  RowRules rules_;
};

// The unit of `quantity`: that of the user, otherwise that of the header.
std::optional<Unit> unit_of(Quantity quantity, const ImportRequest& request, const ForeignColumn& column) {
  for (const Unit& unit : request.units) {
    if (unit.quantity == quantity) return unit;
  }
  return column.parts.unit;
}

Status Importer::find_columns() {
  const TableLayout& layout = table_.layout;
  std::string_view rest = text_.substr(layout.data_offset);
  while (first_rows_.size() < kFirstRows && !rest.empty()) {
    split_table_fields(next_line(rest), layout.delimiter, first_rows_.emplace_back());
  }
  header_ = foreign_columns(layout, first_rows_);
  const bool has_header = !layout.names.empty();
  auto choice = choose_columns(header_, request_.columns, has_header, true);
  // With a given rate the times of the file are only compared with it.
  if (request_.rate_Hz && !choice) choice = choose_columns(header_, request_.columns, has_header, false);
  if (!choice) return fail(choice.error().message);
  velocity_ = find_velocity(header_);
  table_.columns = std::move(*choice);
  return {};
}

// Finds the unit of position or force.
Status Importer::find_unit_of(std::size_t role) {
  const Quantity quantity = static_cast<Quantity>(role);
  const auto& column = header_[index_of(role)];
  const std::optional<Unit> unit = unit_of(quantity, request_, column);
  if (unit && unit->quantity != quantity) {
    return fail("found the unit " + std::string(unit->name) + " in the column \"" + printable(column.header) +
                "\", expected one of a " + (role == 1 ? "length" : "force") + " for the " + kRoleNames[role] +
                "; choose another with --columns " + kRoleNames[role] + "=NAME; the columns are " +
                list_columns(header_));
  }
  const double volts = role == 2 ? volts_of(column.parts.foreign_unit) : 0.0;
  if (role == 2 && request_.gain_N_per_V) {
    use_unit(role, {"V", quantity, (volts > 0.0 ? volts : 1.0) * *request_.gain_N_per_V});
    return {};
  }
  if (volts > 0.0) {
    return fail("found volts in the column \"" + printable(column.header) +
                "\", expected a force; say how many newtons a volt is: --gain N_PER_V");
  }
  if (!unit) {
    return fail("found no unit of the " + std::string(kRoleNames[role]) + quoted_name(index_of(role)) +
                "; add --units " + (role == 1 ? "mm (or m, cm, um, inch)" : "N (or mN, kN, g, kg, lbf)") +
                ", with a comma between two units: --units mm,N");
  }
  use_unit(role, *unit);
  return {};
}

// The times are those of a clock, have a unit from the header or the user, or are in the only unit with a valid rate.
Status Importer::find_time_unit() {
  const std::size_t index = index_of(0);
  std::vector<std::string_view> fields;
  for (const auto& row : first_rows_) fields.push_back(index < row.size() ? row[index] : std::string_view());
  times_ = RowTimes(table_.layout.decimal);
  const double step = times_.examine(fields);
  std::optional<Unit> unit = unit_of(Quantity::time, request_, header_[index]);
  if (times_.are_of_a_clock()) unit = Unit{"clock", Quantity::time, 1.0};
  if (unit && unit->quantity == Quantity::time) {
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
    return fail("found no unit of the time" + quoted_name(index) + " and steps of " + short_number(step) +
                "; add --units " + choices + ", or --rate HZ if the rows are evenly spaced");
  }
  use_unit(0, possible.front());
  note("the header has no unit of time: taken as " + table_.columns[0].unit + ", the only unit in which steps of " +
       short_number(step) + " are a rate of 10 Hz to 20 kHz");
  return {};
}

// Parses the fields of a row. Returns the first column without a valid value.
std::optional<std::size_t> Importer::parse_row(RecordingRow& row) {
  const auto is_bad = [&](std::size_t index, double to_si, double& value) {
    if (!parse_table_number(field(index), table_.layout.decimal, value)) return true;
    value *= to_si;
    return false;
  };
  if (is_bad(index_of(1), to_si_[1], row.position_m)) return index_of(1);
  if (is_bad(index_of(2), to_si_[2], row.force_N)) return index_of(2);
  if (velocity_ && is_bad(velocity_->column, velocity_->to_si, row.velocity_m_per_s)) return velocity_->column;
  const auto time = own_time_ ? times_.since_first(field(index_of(0))) : std::nullopt;
  if (time) own_seconds_ = row.time_s = to_si_[0] * *time;
  return time || request_.rate_Hz ? std::nullopt : std::optional(index_of(0));
}

// The error of the present row, whose field of this column could not be read.
Error Importer::unreadable(std::size_t column, std::uint64_t line) const {
  const std::string_view text = trimmed(field(column));
  std::size_t role = 0;
  while (role < kRoles && index_of(role) != column) ++role;
  return fail_at(line, "found " + (text.empty() ? "an empty field" : '"' + printable(text) + '"') + " in column " +
                           std::to_string(column + 1) + quoted_name(column) + ", expected the " +
                           (role < kRoles ? kRoleNames[role] : "velocity") +
                           "; remove the row, repair the value, or leave up to N such rows out: --skip-bad-rows N");
}

Error Importer::broken(const RowFault& fault, std::uint64_t line) const {
  if (fault.place == RowFault::Place::kEnd) return fail(fault.text);
  const auto role = static_cast<std::size_t>(fault.role);
  const bool has_unit = role < kRoles && !(role == 0 && request_.rate_Hz);
  return fail_at(
      fault.place == RowFault::Place::kFirstRow ? table_.layout.data_line : line,
      fault.text + (has_unit ? ", or give the unit of " + column_words(table_.columns[role]) + " with --units" : ""));
}

// Refuses a time before that of the last row.
Status Importer::check_time(const RecordingRow& row, std::uint64_t line) {
  if (times_.midnights() > midnights_) {
    note("the clock passes midnight in line " + std::to_string(line) + ": a day is added from there");
    ++midnights_;
  }
  const auto& rows = table_.recording.rows;
  if (rows.empty() || row.time_s >= rows.back().time_s) return {};
  const double last_s = rows.back().time_s;
  // The mean rate of the rows so far.
  const std::string rate =
      rows.size() > 2 ? short_number(std::round(static_cast<double>(rows.size() - 1) / last_s)) : "HZ";
  return fail_at(line, "found a time " + short_number(last_s - row.time_s) + " s before that of the row above" +
                           quoted_name(index_of(0)) +
                           ", expected later times in every row; split the file there, or sort its rows; if the rows "
                           "are evenly spaced, add --rate " +
                           rate);
}

// Reads every row in one pass. Other lines are allowed at the end only, except for the number of bad rows that the
// request allows.
Status Importer::read_rows() {
  constexpr const char* kDigits = "0123456789";
  std::string_view rest = text_.substr(table_.layout.data_offset);
  auto& rows = table_.recording.rows;
  std::uint64_t number = table_.layout.data_line - 1;
  std::uint64_t comments = 0;
  std::uint64_t repeated = 0;
  std::uint64_t bad_rows = 0;
  std::uint64_t footer_lines = 0;  // other lines since the last row
  std::uint64_t footer_line = 0;   // the first of them
  std::string_view footer;
  std::optional<Error> footer_fault;
  while (!rest.empty()) {
    const std::string_view line = next_line(rest);
    ++number;
    RecordingRow row;
    split_table_fields(line, table_.layout.delimiter, row_);
    if (const auto bad = parse_row(row)) {
      const std::string_view bare = trimmed(line);
      if (bare.empty()) continue;
      if (bare.starts_with('#')) {
        ++comments;
      } else if (field(index_of(1)).find_first_of(kDigits) < line.size() &&
                 field(index_of(2)).find_first_of(kDigits) < line.size()) {
        // The fields of its numbers contain digits: a damaged row.
        if (++bad_rows > request_.skip_bad_rows) return unreadable(*bad, number);
      } else if (++footer_lines == 1) {
        footer_line = number;
        footer = line;
        footer_fault = unreadable(*bad, number);
      }
      continue;
    }
    // Lines that are followed by rows are no footer.
    bad_rows += footer_lines;
    if (footer_lines > 0 && bad_rows > request_.skip_bad_rows) return *footer_fault;
    footer_lines = 0;
    if (request_.flip_position) {
      row.position_m = -row.position_m;
      row.velocity_m_per_s = -row.velocity_m_per_s;
    }
    if (request_.flip_force) row.force_N = -row.force_N;
    if (request_.rate_Hz) {
      row.time_s = static_cast<double>(rows.size()) / *request_.rate_Hz;
    } else if (const Status status = check_time(row, number); !status) {
      return status;
    } else if (!rows.empty() && row.time_s == rows.back().time_s) {
      ++repeated;
      continue;
    }
    if (const auto fault = rules_.check(row)) return broken(*fault, number);
    rows.push_back(row);
  }
  if (comments > 0) note("left out " + count_of(comments, "comment line") + " between the rows");
  if (repeated > 0) note("left out " + count_of(repeated, "row") + " with the time of the previous row");
  if (bad_rows > 0) note("left out " + count_of(bad_rows, "unreadable row"));
  if (footer_lines > 0) {
    note("left out " + count_of(footer_lines, "line") + " after the table, from line " + std::to_string(footer_line) +
         " \"" + printable(footer) + "\"");
  }
  return {};
}

void Importer::describe_time() {
  if (request_.rate_Hz) {
    note("the rows are evenly spaced at the --rate of " + short_number(*request_.rate_Hz) + " Hz");
    const double seconds = table_.recording.rows.back().time_s;
    if (!own_time_ || std::abs(seconds - own_seconds_) <= kRateTolerance * own_seconds_) return;
    note("warning: with --rate " + short_number(*request_.rate_Hz) + " the recording is " + short_number(seconds) +
         " s long, but " + short_number(own_seconds_) + " s by the times in the file");
  } else if (times_.are_of_a_clock()) {
    note(times_.have_dates() ? "the times are dates: time_s is 0 at the first row"
                             : "the times are times of day: time_s is 0 at the first row");
  } else if (const double start_s = to_si_[0] * times_.first(); start_s != 0.0) {
    note("the first time was " + short_number(start_s) + " s: time_s is 0 there");
  }
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
  if (table_.layout.step_s > 0.0 && !request_.rate_Hz) {
    request_.rate_Hz = 1.0 / table_.layout.step_s;
    note("the rows are evenly spaced by the Delta_X above the table");
  }
  if (const Status status = find_columns(); !status) return status.error();
  if (table_.columns[0].number > 0) {
    const std::size_t notes = table_.notes.size();
    const Status status = find_time_unit();
    own_time_ = status.ok();
    if (!status && !request_.rate_Hz) return status.error();
    if (request_.rate_Hz) table_.notes.resize(notes);
  }
  for (const std::size_t role : {1u, 2u}) {
    if (const Status status = find_unit_of(role); !status) return status.error();
  }
  if (const Status status = read_rows(); !status) return status.error();
  if (const auto fault = rules_.finish()) return broken(*fault, 0);
  describe_time();
  check_velocity();
  if (request_.rate_Hz) table_.columns[0] = {};
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

std::string column_words(const ImportedColumn& column) {
  if (column.number == 0) return "from --rate";
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
  for (std::size_t role = 0; role < kRoles; ++role) {
    comments.push_back(std::string(kRoleNames[role]) + ": " + column_words(table.columns[role]));
  }
  for (const std::string& flip : flipped_roles(request)) comments.push_back(flip + ": sign reversed");
  return comments;
}

}  // namespace palpate
