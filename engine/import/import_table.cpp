#include "engine/import/import_table.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <utility>

#include "engine/base/text.h"
#include "engine/import/table_cell.h"
#include "engine/import/table_columns.h"

namespace palpate {
namespace {

constexpr double kVelocitySlope = 0.2;
// A time that falls to this share of the time so far begins another recording.
constexpr double kRestartShare = 0.5;
// A channel is slower than the rows if it has no value in so many rows.
constexpr std::uint64_t kSlowRows = 10;

std::string short_number(double value) { return general(value, 6); }

// "3 rows"
std::string count_of(std::uint64_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

// Rows that are not used.
struct LeftOut {
  std::uint64_t rows = 0;
  std::array<std::uint64_t, kRoles> missing{};  // rows without a value, by channel

  void add(const LeftOut& more) {
    rows += more.rows;
    for (std::size_t role = 0; role < kRoles; ++role) missing[role] += more.missing[role];
  }
  bool is_slow_channel() const {
    const std::uint64_t most = std::max(missing[1], missing[2]);
    return most >= kSlowRows && 2 * most >= rows;
  }
};

class Importer : ImportMessages {
 public:
  Importer(const ForeignText& foreign, const std::string& path, const ImportRequest& request)
      : ImportMessages{path}, text_(foreign.text), request_(request) {
    table_.encoding = foreign.encoding;
  }

  // Parses the fields of a row. Returns the first column without a valid value.
  std::optional<std::size_t> parse_row(RecordingRow& row) {
    const auto is_bad = [&](std::size_t index, double to_si, double& value) {
      if (!parse_table_number(field(index), table_.layout.decimal, value)) return true;
      value *= to_si;
      return false;
    };
    if (is_bad(index_of(1), columns_.to_si[1], row.position_m)) return index_of(1);
    if (is_bad(index_of(2), columns_.to_si[2], row.force_N)) return index_of(2);
    if (const auto& velocity = columns_.velocity) {
      if (is_bad(velocity->column, velocity->to_si, row.velocity_m_per_s)) {
        if (!is_empty(velocity->column)) return velocity->column;
        gaps_in_velocity_ = true;
      }
    }
    const auto time = columns_.own_time ? columns_.times.since_first(field(index_of(0))) : std::nullopt;
    row_seconds_ = time ? std::optional(columns_.to_si[0] * *time) : std::nullopt;
    row.time_s = row_seconds_.value_or(0.0);
    return time || request_.rate_Hz ? std::nullopt : std::optional(index_of(0));
  }

  // Whether the present row has numbers, so that it is no line of text.
  bool has_numbers() const { return has_digits(1) && has_digits(2); }

  // Counts the present row, which has a time, for each channel without a value.
  void count_missing(std::array<std::uint64_t, kRoles>& missing) const {
    if (columns_.own_time && !has_digits(0)) return;
    for (const std::size_t role : {1u, 2u})
      if (is_empty(index_of(role))) ++missing[role];
  }

  // The error of the present row, whose field of this column could not be read.
  Error unreadable(std::size_t column, std::uint64_t line) const {
    const auto& names = table_.layout.names;
    if (row_.size() > 1 && row_.size() <= names.size() && std::equal(row_.begin(), row_.end(), names.begin())) {
      return fail_at(line,
                     "found the header again, as where a second recording begins, expected one table; split the "
                     "file at this line, or leave up to N such rows out: --skip-bad-rows N");
    }
    const std::string_view text = trimmed(field(column));
    std::size_t role = 0;
    while (role < kRoles && index_of(role) != column) ++role;
    return fail_at(line, "found " + (text.empty() ? "an empty field" : '"' + printable(text) + '"') + " in column " +
                             std::to_string(column + 1) + columns_.quoted_name(column) + ", expected the " +
                             (role < kRoles ? kRoleNames[role] : "velocity") +
                             "; remove the row, repair the value, or leave up to N such rows out: --skip-bad-rows N");
  }

  // The error of a channel that has no value in most of the bad rows.
  Error slow_channel(const LeftOut& left_out) const {
    const auto& missing = left_out.missing;
    const std::size_t role = missing[1] > missing[2] ? 1 : 2, full = table_.recording.rows.size();
    const std::string found = "found no value of the " + std::string(kRoleNames[role]) + " in column " +
                              std::to_string(index_of(role) + 1) + columns_.quoted_name(index_of(role)) + " in " +
                              std::to_string(missing[role]) + " of " + std::to_string(full + left_out.rows) +
                              " rows, expected one in every row; ";
    if (full == 0)
      return fail(found + "no row has both position and force: resample both to common times before the import");
    return fail(found + "to use only the " + std::to_string(full) + " full rows, add --skip-bad-rows " +
                std::to_string(left_out.rows) + ", or fill the empty fields by interpolation before the import");
  }

  Error broken(const RowFault& fault, std::uint64_t line) const {
    if (fault.place == RowFault::Place::kEnd) return fail(fault.text);
    const auto role = static_cast<std::size_t>(fault.role);
    const bool has_unit = role < kRoles && columns_.roles[role].unit != "clock" && !(role == 0 && request_.rate_Hz);
    return fail_at(
        fault.place == RowFault::Place::kFirstRow ? table_.layout.data_line : line,
        fault.text + (has_unit ? ", or give the unit of " + column_words(columns_.roles[role]) + " with --units" : ""));
  }

  // Refuses a time of the present row before that of the last one.
  Status check_time(std::uint64_t line) {
    if (!row_seconds_) return {};
    if (columns_.times.midnights() > midnights_) {
      note("the clock passes midnight in line " + std::to_string(line) + ": a day is added from there");
      ++midnights_;
    }
    const double last_s = std::exchange(own_seconds_, *row_seconds_);
    if (own_seconds_ >= last_s) return {};
    const std::size_t rows = table_.recording.rows.size();
    const bool restarts = rows >= kRecordingMinimumRows && own_seconds_ < kRestartShare * last_s;
    if (request_.rate_Hz) {
      if (restarts && restart_line_ == 0) restart_line_ = line;
      return {};
    }
    // The mean rate of the rows so far.
    const std::string rate = rows > 2 ? short_number(std::round(static_cast<double>(rows - 1) / last_s)) : "HZ";
    return fail_at(line, "found a time " + short_number(last_s - own_seconds_) + " s before that of the row above" +
                             columns_.quoted_name(index_of(0)) + ", expected later times in every row; " +
                             (restarts ? "a second recording begins here: split the file at this line"
                                       : "split the file there, or sort its rows; if the rows are evenly spaced, add "
                                         "--rate " +
                                             rate));
  }

  Status add_row(RecordingRow row, std::uint64_t line) {
    if (request_.flip_position) {
      row.position_m = -row.position_m;
      row.velocity_m_per_s = -row.velocity_m_per_s;
    }
    if (request_.flip_force) row.force_N = -row.force_N;
    if (const Status status = check_time(line); !status) return status;
    auto& rows = table_.recording.rows;
    if (request_.rate_Hz) row.time_s = static_cast<double>(rows.size()) / *request_.rate_Hz;
    // Repeated times and the rate are examined when all rows are known.
    if (rows.empty() || row.time_s != rows.back().time_s) {
      const auto fault = rules_.check(row);
      if (fault && fault->place == RowFault::Place::kThisRow) return broken(*fault, line);
    }
    rows.push_back(row);
    return {};
  }

  // Reads every row in one pass. Other lines are allowed at the end only, except for the number of bad rows that the
  // request allows.
  Status read_rows() {
    std::string_view rest = text_.substr(table_.layout.data_offset);
    std::uint64_t number = table_.layout.data_line - 1, comments = 0;
    LeftOut bad;
    LeftOut footer;  // other lines since the last row
    std::uint64_t footer_line = 0;
    std::string_view footer_text;
    std::optional<Error> footer_fault;
    std::optional<Error> fault;  // of the first bad row beyond the allowed number
    while (!rest.empty()) {
      const std::string_view line = next_line(rest);
      ++number;
      RecordingRow row;
      split_table_fields(line, table_.layout.delimiter, row_);
      if (const auto column = parse_row(row)) {
        const std::string_view bare = trimmed(line);
        if (bare.empty()) continue;
        if (bare.starts_with('#')) {
          ++comments;
        } else if (has_numbers()) {  // a damaged row
          if (++bad.rows > request_.skip_bad_rows && !fault) fault = unreadable(*column, number);
        } else {
          count_missing(footer.missing);
          if (++footer.rows > 1) continue;
          footer_line = number;
          footer_text = line;
          footer_fault = unreadable(*column, number);
        }
        continue;
      }
      // Lines that are followed by rows are no footer.
      bad.add(std::exchange(footer, {}));
      if (bad.rows > request_.skip_bad_rows && !fault) fault = footer_fault;
      if (Status status = add_row(row, number); !status) return fault ? Status(*fault) : status;
    }
    if (fault || table_.recording.rows.empty()) {
      bad.add(footer);
      if (bad.is_slow_channel()) return slow_channel(bad);
    }
    if (fault) return *fault;
    if (comments > 0) note("left out " + count_of(comments, "comment line") + " between the rows");
    if (bad.rows > 0) note("left out " + count_of(bad.rows, "unreadable row"));
    if (footer.rows > 0) {
      note("left out " + count_of(footer.rows, "line") + " after the table, from line " + std::to_string(footer_line) +
           " \"" + printable(footer_text) + "\"");
    }
    return {};
  }

  // Rows that share a time are evenly spaced if the clock is coarse; otherwise the first of them is used.
  Status resolve_repeated_times() {
    auto& rows = table_.recording.rows;
    const RepeatedTimes repeated = find_repeated_times(rows);
    if (repeated.rows == 0) return {};
    const std::string shared = std::to_string(repeated.rows) + " of " + std::to_string(rows.size()) + " rows";
    if (repeated.rate_Hz && !repeated.copies) {
      for (std::size_t i = 0; i < rows.size(); ++i) rows[i].time_s = static_cast<double>(i) / *repeated.rate_Hz;
      note("warning: the clock" + columns_.quoted_name(index_of(0)) + " has steps of " + short_number(repeated.step_s) +
           " s, and " + shared +
           " have the time of the row above: the rows are taken as evenly spaced, as with --rate " +
           short_number(*repeated.rate_Hz));
      return {};
    }
    if (!repeated.copies && 2 * repeated.rows > rows.size()) {
      return fail("found the time of the row above" + columns_.quoted_name(index_of(0)) + " in " + shared +
                  ", expected a later time in every row; write the times with more digits, or, if the rows are evenly "
                  "spaced, add --rate " +
                  (repeated.mean_rate_Hz > 0.0 ? short_number(repeated.mean_rate_Hz) : "HZ"));
    }
    rows.erase(std::unique(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.time_s == b.time_s; }),
               rows.end());
    note("left out " + count_of(repeated.rows, "row") + " with the time of the previous row");
    return {};
  }

  void describe_time() {
    if (request_.rate_Hz) {
      note("the rows are evenly spaced at the --rate of " + short_number(*request_.rate_Hz) + " Hz");
      const double seconds = table_.recording.rows.back().time_s;
      if (restart_line_ > 0) {
        note("warning: the times in the file begin again in line " + std::to_string(restart_line_) +
             ", as where a second recording begins: --rate joins both parts; split the file there");
      } else if (columns_.own_time && std::abs(seconds - own_seconds_) > kRateTolerance * own_seconds_) {
        note("warning: with --rate " + short_number(*request_.rate_Hz) + " the recording is " + short_number(seconds) +
             " s long, but " + short_number(own_seconds_) + " s by the times in the file");
      }
    } else if (columns_.times.are_of_a_clock()) {
      note(columns_.times.have_dates() ? "the times are dates: time_s is 0 at the first row"
                                       : "the times are times of day: time_s is 0 at the first row");
    } else if (const double start_s = columns_.to_si[0] * columns_.times.first(); start_s != 0.0) {
      note("the first time was " + short_number(start_s) + " s: time_s is 0 there");
    }
  }

  // Drops a velocity that is not the derivative of the position (unsigned, a set value): the slope of one over the
  // other must be 1 within a fifth.
  void check_velocity() {
    if (!columns_.velocity) return;
    auto& rows = table_.recording.rows;
    double both = 0.0, squares = 0.0;
    for (std::size_t i = 1; i + 1 < rows.size(); ++i) {
      const double rate = (rows[i + 1].position_m - rows[i - 1].position_m) / (rows[i + 1].time_s - rows[i - 1].time_s);
      both += rows[i].velocity_m_per_s * rate;
      squares += rows[i].velocity_m_per_s * rows[i].velocity_m_per_s;
    }
    const std::string column = "column " + std::to_string(columns_.velocity->column + 1) + " \"" +
                               printable(columns_.header[columns_.velocity->column].header) + "\"";
    table_.recording.columns.velocity =
        !gaps_in_velocity_ && squares > 0.0 && std::abs(both / squares - 1.0) <= kVelocitySlope;
    if (table_.recording.columns.velocity) return note("the velocity is " + column);
    for (RecordingRow& row : rows) row.velocity_m_per_s = 0.0;
    note(column + (gaps_in_velocity_ ? " has empty fields" : " is not the derivative of the position") + ": left out");
  }

  Result<ImportedTable> run() {
    auto layout = find_table_layout(text_, request_.decimal);
    if (!layout) return fail(layout.error().message);
    table_.layout = std::move(*layout);
    if (table_.layout.step_s > 0.0 && !request_.rate_Hz) {
      request_.rate_Hz = 1.0 / table_.layout.step_s;
      note("the rows are evenly spaced by the Delta_X above the table");
    }
    auto columns = find_table_columns(text_, request_, table_.layout, *this);
    if (!columns) return columns.error();
    columns_ = std::move(*columns);
    if (const Status status = read_rows(); !status) return status.error();
    if (const Status status = resolve_repeated_times(); !status) return status.error();
    RowRules rules;
    for (const RecordingRow& row : table_.recording.rows)
      if (const auto fault = rules.check(row)) return broken(*fault, table_.layout.data_line);
    if (const auto fault = rules.finish()) return broken(*fault, table_.layout.data_line);
    describe_time();
    check_velocity();
    table_.columns = std::move(columns_.roles);
    if (request_.rate_Hz) table_.columns[0] = {};
    table_.layout.names.clear();
    table_.layout.units.clear();
    table_.notes = std::move(notes);
    table_.recording.name = printable(std::filesystem::path(label).stem().string(), std::string::npos);
    return std::move(table_);
  }

 private:
  std::size_t index_of(std::size_t role) const { return columns_.index_of(role); }
  // The field of a column in the present row; empty if it is missing.
  std::string_view field(std::size_t index) const { return index < row_.size() ? row_[index] : std::string_view(); }
  bool has_digits(std::size_t role) const {
    return field(index_of(role)).find_first_of("0123456789") != std::string_view::npos;
  }
  bool is_empty(std::size_t index) const { return field(index).empty() || is_missing_value(field(index)); }

  std::string_view text_;
  ImportRequest request_;
  ImportedTable table_;
  TableColumns columns_;
  std::vector<std::string_view> row_;  // the fields of the present row
  int midnights_ = 0;                  // that a note names
  std::optional<double> row_seconds_;  // the time of the present row in the file
  double own_seconds_ = 0.0;           // the last of these times
  std::uint64_t restart_line_ = 0;     // where the times of the file begin again, with a given rate
  bool gaps_in_velocity_ = false;
  RowRules rules_;
};

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
  for (std::size_t role = 0; role < kRoles; ++role)
    comments.push_back(std::string(kRoleNames[role]) + ": " + column_words(table.columns[role]));
  for (const std::string& flip : flipped_roles(request)) comments.push_back(flip + ": sign reversed");
  std::ranges::copy_if(table.notes, std::back_inserter(comments),
                       [](const std::string& note) { return note.starts_with("warning:"); });
  return comments;
}

}  // namespace palpate
