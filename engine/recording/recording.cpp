#include "engine/recording/recording.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <filesystem>
#include <string_view>
#include <tuple>
#include <utility>

#include "engine/base/files.h"
#include "engine/base/parallel.h"
#include "engine/base/statistics.h"
#include "engine/base/text.h"

namespace palpate {
namespace {

// The advice for a median step outside of the valid range.
std::string rate_advice(double step_s) {
  if (step_s < 1.0 / kMaximumRate_Hz) return "keep fewer samples, or check that time_s is in seconds";
  for (const auto& [name, divisor, seconds] : {std::tuple{"milliseconds", "1000", 1e-3},
                                               {"microseconds", "1000000", 1e-6},
                                               {"nanoseconds", "1000000000", 1e-9}}) {
    if (rate_in_range(step_s * seconds))
      return std::string("if time_s is in ") + name + ", divide it by " + divisor + ", otherwise record faster";
  }
  return "record faster, or check that time_s is in seconds";
}

constexpr std::size_t kSlices = 16;
// Slices of the range of positions that make up an end.
constexpr std::size_t kEndSlices = 4;
// An end whose force is below this share of the force at the other end is the shallow one. Above it an offset of the
// force may hide that.
constexpr double kShallowShare = 0.35;
// Free air: the force is below this share of the force at the deep end, and flat to this share.
constexpr double kAirShare = 0.1;
// The least ratio of the changes of force at the two ends that identifies the deep end.
constexpr double kClearRatio = 2.0;

struct Slice {
  double sum_N = 0.0;
  std::size_t count = 0;
};

// The mean force of the outermost slice, and the spread of the means of one end.
struct EndForce {
  double outermost_N = 0.0, spread_N = 0.0;
};

EndForce end_force(const std::array<Slice, kSlices>& slices, bool low) {
  std::vector<double> means_N;
  for (std::size_t i = 0; i < kEndSlices; ++i) {
    const Slice& slice = slices[low ? i : kSlices - 1 - i];
    if (slice.count > 0) means_N.push_back(slice.sum_N / static_cast<double>(slice.count));
  }
  const auto [least_N, largest_N] = std::ranges::minmax(means_N);
  return {means_N.front(), largest_N - least_N};
}

}  // namespace

std::uint64_t content_hash(const Recording& recording, std::uint64_t hash) {
  for (const RecordingRow& row : recording.rows) {
    for (const double value : column_values(row)) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001B3ULL;
      hash ^= hash >> 29;
    }
  }
  return hash;
}

Status write_recording(const std::string& path, const Recording& recording, const std::vector<std::string>& comments,
                       bool overwrite) {
  auto writer = RecordingWriter::create(path, recording.columns, comments, overwrite);
  if (!writer) return writer.error();
  for (const RecordingRow& row : recording.rows)
    if (Status added = writer->add(row); !added) return added;
  return writer->commit();
}

bool rate_in_range(double step_s) {
  return step_s <= (1.0 + kRateTolerance) / kMinimumRate_Hz && step_s >= (1.0 - kRateTolerance) / kMaximumRate_Hz;
}

RowFault RowRules::explain(const RecordingRow& row) const {
  const auto fault = [](ColumnRole role, double found, const std::string& words) {
    const std::string name(kColumnNames[static_cast<std::size_t>(role)]);
    return RowFault{RowFault::Place::kThisRow, role, "found " + name + " " + shortest(found) + words};
  };
  const auto values = column_values(row);
  const auto wrong = std::ranges::find_if_not(values, [](double value) { return std::isfinite(value); });
  if (wrong != values.end()) {
    return fault(static_cast<ColumnRole>(wrong - values.begin()), *wrong,
                 ", expected a finite number; remove the row or repair the value");
  }
  if (!(row.time_s > last_time_s_)) {
    return fault(ColumnRole::kTime, row.time_s,
                 " after " + shortest(last_time_s_) + ", expected a later time in every row; " +
                     (row.time_s == last_time_s_ ? "remove the repeated row or write time_s with more digits"
                                                 : "sort the rows, or split the file where time starts again"));
  }
  if (std::abs(row.position_m) > kMaximumPosition_m) {
    return fault(ColumnRole::kPosition, row.position_m,
                 ", expected metres from the surface, at most 1 either way; palpate import FILE --out REC.csv moves "
                 "its zero with "
                 "--zero first, and reads millimetres with --units mm,N");
  }
  return fault(ColumnRole::kForce, row.force_N,
               ", expected newtons, at most 1000000 either way; check the unit of the column");
}

std::optional<RowFault> RowRules::check_rate() {
  // With an even number of steps the median is the upper of the two middle ones.
  const double step_s = nth_smallest(steps_s_, steps_s_.size() / 2);
  if (rate_in_range(step_s)) return std::nullopt;
  return RowFault{RowFault::Place::kFirstRow, ColumnRole::kTime,
                  "found a median time step of " + general(step_s, 3) + " s (" + general(1.0 / step_s, 3) +
                      " Hz), expected 10 Hz to 20 kHz; " + rate_advice(step_s)};
}

std::optional<RowFault> RowRules::finish() {
  if (rows_ < kRecordingMinimumRows) {
    return RowFault{RowFault::Place::kEnd, ColumnRole::kTime,
                    "found " + std::to_string(rows_) + (rows_ == 1 ? " row" : " rows") + ", expected at least " +
                        std::to_string(kRecordingMinimumRows) + "; record for longer"};
  }
  return rows_ < kRateRows ? check_rate() : std::nullopt;
}

PressDirection find_press_direction(const std::vector<RecordingRow>& rows) {
  PressDirection direction;
  const auto [lowest, highest] = std::ranges::minmax(rows, {}, &RecordingRow::position_m);
  const double lowest_m = lowest.position_m, highest_m = highest.position_m;
  if (!(highest_m > lowest_m)) return direction;
  std::array<Slice, kSlices> slices{};
  const double per_metre = static_cast<double>(kSlices) / (highest_m - lowest_m);
  for (const RecordingRow& row : rows) {
    const auto index = static_cast<std::size_t>((row.position_m - lowest_m) * per_metre);
    Slice& slice = slices[std::min(index, kSlices - 1)];
    slice.sum_N += row.force_N;
    ++slice.count;
  }
  const EndForce low = end_force(slices, true);
  const EndForce high = end_force(slices, false);
  const double low_N = std::abs(low.outermost_N), high_N = std::abs(high.outermost_N);
  const bool clear = std::min(low_N, high_N) < kShallowShare * std::max(low_N, high_N);
  const bool by_spread = std::max(low.spread_N, high.spread_N) > kClearRatio * std::min(low.spread_N, high.spread_N);
  if (!clear && !by_spread) return direction;
  const bool flipped = clear ? high_N < low_N : high.spread_N < low.spread_N;
  const EndForce& shallow = flipped ? high : low;
  const EndForce& deep = flipped ? low : high;
  const double air_N = std::max(shallow.spread_N, std::abs(shallow.outermost_N));
  return {true,
          air_N < kAirShare * std::abs(deep.outermost_N),
          flipped,
          deep.outermost_N < shallow.outermost_N,
          shallow.outermost_N,
          deep.outermost_N};
}

namespace {

// The longest comment: '#', a blank and the text fit in one line.
constexpr std::size_t kMaximumCommentBytes = kMaximumLineBytes - 2;

// Appends one '#' line for each line of `comment`, up to the longest comment. Control characters become blanks, because
// the reader would refuse them or take them for line ends.
void append_comment(std::string& out, std::string_view comment) {
  for (;;) {
    const std::size_t newline = comment.find('\n');
    out += "# ";
    for (const char c : comment.substr(0, std::min(newline, kMaximumCommentBytes)))
      out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    out += '\n';
    if (newline == std::string_view::npos) return;
    comment.remove_prefix(newline + 1);
  }
}

// A line with a field for each column that the file has.
template <typename Field>
std::string line_of(RecordingColumns columns, const Field& field) {
  const std::array present = {true, true, columns.force, columns.velocity, columns.acceleration};
  std::string line;
  line.reserve(128);  // five doubles of at most 24 characters
  for (std::size_t i = 0; i < present.size(); ++i)
    if (present[i]) line.append(i > 0 ? "," : "").append(field(i));
  return line + '\n';
}

}  // namespace

Result<RecordingWriter> RecordingWriter::create(const std::string& path, RecordingColumns columns,
                                                const std::vector<std::string>& comments, bool overwrite,
                                                bool in_part) {
  auto file = in_part ? AtomicFile::create_in_part(path, overwrite) : AtomicFile::create(path, overwrite);
  if (!file) return file.error();
  std::string head;
  for (const std::string& comment : comments) append_comment(head, comment);
  file->write(head + line_of(columns, [](std::size_t i) { return kColumnNames[i]; }));
  return RecordingWriter(std::move(*file), path, columns);
}

Status RecordingWriter::add(const RecordingRow& row) {
  if (const auto fault = rules_.check(row))
    return Error{path_ + ": cannot write row " + std::to_string(rules_.rows() + 1) + ": " + fault->text};
  const auto values = column_values(row);
  file_.write(line_of(columns_, [&](std::size_t i) { return shortest(values[i]); }));
  return {};
}

Status RecordingWriter::flush() {
  Status flushed = file_.flush_part();
  if (flushed) flushed_rows_ = rules_.rows();
  return flushed;
}

Status RecordingWriter::commit() {
  if (file_.failed()) return file_.commit();
  if (const auto fault = rules_.finish()) {
    const AtomicFile given_up = std::move(file_);
    return Error{path_ + ": cannot write: " + fault->text};
  }
  return file_.commit();
}

// Reads recordings, with the messages of all faults.

namespace {

// The largest number of rows for which memory is reserved: untouched memory costs nothing, and a growing vector would
// have its rows twice at times.
constexpr std::size_t kMostExpected = 6000000;
constexpr std::size_t kShortestRow = 6;  // bytes of "0,0,0" and a line end

// Bytes beyond the longest line that are read: a byte order mark, a carriage return, one byte that shows that the line
// is too long, and the terminator.
constexpr std::size_t kBeyondLimit = 6;

bool parse_field(std::string_view field, double& value) {
  field = trimmed(field);
  return parse_number(field.data(), field.data() + field.size(), value) == field.data() + field.size();
}

// The functions below explain why a line was refused: slow, once a file.

bool is_number(std::string_view text) {
  double value = 0.0;
  return parse_field(text, value);
}

// `text` without blanks and one pair of quotes around it.
std::string_view bare(std::string_view text) {
  text = trimmed(text);
  for (const char quote : {'"', '\''})
    if (text.size() >= 2 && text.starts_with(quote) && text.ends_with(quote))
      return trimmed(text.substr(1, text.size() - 2));
  return text;
}

// The value in a field; of a blank field the field itself.
std::string_view value_of(std::string_view field) {
  const std::string_view value = trimmed(field);
  return value.empty() ? field : value;
}

// Why a line was refused, and the part of the line at which a message points.
struct LineFault {
  std::string_view at;
  std::string text;
};

// The fault of a line with semicolons or tabs between at least `fields` fields.
std::optional<LineFault> foreign_separator(std::string_view line, std::size_t fields) {
  for (const auto& [mark, name] : {std::pair{';', "semicolons"}, {'\t', "tabs"}}) {
    if (static_cast<std::size_t>(std::count(line.begin(), line.end(), mark)) + 1 < fields) continue;
    return LineFault{line.substr(line.find(mark)),
                     std::string("found ") + name +
                         " between the fields, expected commas; save the file as comma separated with decimal points"};
  }
  return std::nullopt;
}

std::string no_header(const std::string& found, const std::string& advice) {
  return "found " + found + ", expected a header row with time_s, position_m and force_N; " + advice;
}

LineFault header_fault(std::string_view line, const std::vector<std::string_view>& names,
                       const std::vector<std::string>& missing) {
  if (trimmed(line).empty()) return {line, no_header("a blank line", "remove the blank line")};
  if (missing.size() == kRequiredColumns) {
    if (const auto separator = foreign_separator(line, kRequiredColumns)) return *separator;
    if (std::ranges::all_of(names, is_number)) return {line, no_header("a row of numbers", "add the header row")};
  }
  for (const std::string& wanted : missing) {
    for (const std::string_view name : names) {
      if (lower_ascii(bare(name)) != lower_ascii(wanted)) continue;
      return {value_of(name),
              "found column '" + printable(name) + "', expected exactly " + wanted + "; rename the column"};
    }
  }
  return {line, "found columns " + printable(line, 80) + ", expected also " + joined(missing, " and ") +
                    "; add what is missing or rename what holds the values"};
}

// Explains why `field` is not a valid number for the column `name`.
std::string number_fault(std::string_view field, std::string_view name) {
  const std::string_view text = trimmed(field);
  const std::string lower = lower_ascii(text);
  const std::size_t digits = std::min(lower.find_first_not_of("+-"), lower.size());
  std::string found = '"' + printable(text) + '"';
  const char* advice = "remove the row or repair the value";
  double value = 0.0;
  if (text.empty()) {
    found = "an empty field";
    advice = "fill in the value or remove the row";
  } else if (bare(text).size() != text.size()) {
    found = "quotes around " + printable(bare(text));
    advice = "remove the quotes";
  } else if (lower.compare(digits, 2, "0x") == 0) {
    advice = "write it in decimal";
  } else if (std::from_chars(lower.data() + digits, lower.data() + lower.size(), value).ec ==
             std::errc::result_out_of_range) {
    advice = "it is beyond what a double can hold, repair the value";
  } else if (text.find(';') != std::string_view::npos) {
    advice = "separate fields with commas";
  }
  return "found " + found + ", expected a finite number in " + std::string(name) + "; " + advice;
}

// The fault of a row that cannot be parsed under a header of these columns. `has_end`: it ends with a newline.
LineFault row_fault(std::string_view line, bool has_end, const std::vector<std::string_view>& fields,
                    const std::vector<ColumnRole>& roles, bool header_ends_with_comma) {
  if (line.starts_with('#'))
    return {line, "found a comment after the header, expected a row; move it above the header or remove it"};
  const std::size_t found = fields.size(), expected = roles.size();
  if (found == expected) {
    std::size_t bad = 0;
    while (bad + 1 < found && (roles[bad] == ColumnRole::kIgnored || is_number(fields[bad]))) ++bad;
    return {value_of(fields[bad]), number_fault(fields[bad], kColumnNames[static_cast<std::size_t>(roles[bad])])};
  }
  const auto separator = found < expected ? foreign_separator(line, expected) : std::nullopt;
  if (separator) return *separator;
  const bool cut_off = found < expected && !has_end;
  const char* const advice =
      cut_off                                                 ? "the file was cut off, remove its last line"
      : found + 1 == expected && header_ends_with_comma       ? "remove the comma at the end of the header"
      : found < expected                                      ? "add the missing values or remove the row"
      : found == expected + 1 && trimmed(line).ends_with(',') ? "remove the comma at the end of the row"
      : line.find('"') != std::string_view::npos
          ? "remove quotes and the commas inside them"
          : "write decimal points, not commas, and remove fields without a column";
  return {found < expected ? line.substr(line.size()) : value_of(fields[expected]),
          "found " + std::to_string(found) + (found == 1 ? " field" : " fields") +
              (cut_off ? " where the file ends" : "") + ", expected " + std::to_string(expected) +
              " as in the header; " + advice};
}

// The fault of a line of bytes that are no text.
std::optional<LineFault> bytes_fault(std::string_view line) {
  if (const std::size_t nul = line.find('\0'); nul != std::string_view::npos) {
    return LineFault{line.substr(nul),
                     "found a NUL byte, expected UTF-8 text; this is a binary or UTF-16 file, save it as UTF-8 CSV"};
  }
  if (const std::size_t at = line.find('\r'); at < line.size() - 1) {
    return LineFault{
        line.substr(at),
        "found a carriage return inside a line, expected lines that end in LF or CRLF; convert the line ends"};
  }
  if (line.size() <= kMaximumLineBytes) return std::nullopt;
  return LineFault{line.substr(kMaximumLineBytes),
                   "found a line longer than " + std::to_string(kMaximumLineBytes) +
                       " bytes, expected a row of a recording; check that this is a CSV file with line ends"};
}

class RecordingReader {
 public:
  RecordingReader(std::istream& stream, std::string label)
      : stream_(stream), label_(std::move(label)), buffer_(kMaximumLineBytes + kBeyondLimit) {}

  // Reads the next rows, at most `most_rows`.
  Result<Recording> read(std::size_t most_rows, std::size_t expected_rows) {
    if (roles_.empty() && !read_header()) return *error_;
    Recording recording{printable(std::filesystem::path(label_).stem().string(), std::string::npos),
                        {has(ColumnRole::kVelocity), has(ColumnRole::kAcceleration)},
                        {}};
    recording.rows.reserve(std::min(most_rows, expected_rows));
    for (RecordingRow row; recording.rows.size() < most_rows && next(row);) recording.rows.push_back(row);
    if (error_) return *error_;
    return recording;
  }

 private:
  // The beginning of a message about a part of the present line.
  std::string place_of(std::string_view at) const {
    return label_ + ":" + std::to_string(line_number_) + ":" + std::to_string(at.data() - line_.data() + 1) + ": ";
  }

  // Sets the error and returns false.
  bool fail(const std::string& message) {
    error_ = Error{message};
    return false;
  }
  bool fail(const LineFault& fault) { return fail(place_of(fault.at) + fault.text); }
  bool fail(const RowFault& fault) {
    const std::string_view at = line_.empty() ? line_ : value_of(fields_[index_of(fault.role)]);
    return fail((fault.place == RowFault::Place::kFirstRow ? first_time_ : place_of(at)) + fault.text);
  }

  // The functions below return false at the end of the file and after an error.

  // Lines end with LF or CRLF; a UTF-8 byte order mark is skipped.
  bool next_line() {
    stream_.getline(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    if (stream_.bad()) return fail(unreadable(label_).message);
    // The count includes the line feed, which is not stored.
    const auto count = static_cast<std::size_t>(stream_.gcount());
    line_has_end_ = stream_.good();
    line_ = std::string_view(buffer_.data(), line_has_end_ ? count - 1 : count);
    const bool is_first = line_number_ == 0;
    if (is_first && line_.starts_with("\xEF\xBB\xBF")) line_.remove_prefix(3);
    const bool ended = line_.empty() && !line_has_end_;
    ++line_number_;
    if (ended) return false;
    if (is_first && (line_.starts_with("\xFF\xFE") || line_.starts_with("\xFE\xFF")))
      return fail({line_, "found UTF-16 text, expected UTF-8; save the file as UTF-8 CSV"});
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    const auto fault = bytes_fault(line_);
    return !fault || fail(*fault);
  }

  bool read_header() {
    while (next_line())
      if (!line_.starts_with('#')) return parse_header();
    if (error_) return false;
    return fail({line_, no_header(line_number_ == 1 ? "an empty file" : "the end of the file",
                                  "check that the recording was saved")});
  }

  bool parse_header() {
    if (const std::size_t good = utf8_bytes(line_); good < line_.size()) {
      return fail({line_.substr(good), "found byte " + printable(line_.substr(good, 1)) +
                                           ", expected UTF-8 text in the header; save the file as UTF-8 CSV"});
    }
    split_line();
    for (const std::string_view name : fields_) {
      const auto known = std::find(kColumnNames.begin(), kColumnNames.end(), name);
      const auto role = static_cast<ColumnRole>(known - kColumnNames.begin());  // ignored if the name is unknown
      if (role != ColumnRole::kIgnored && has(role)) {
        return fail(
            {name, "found column " + std::string(name) + " twice, expected it once; remove or rename one of the two"});
      }
      roles_.push_back(role);
    }
    header_ends_with_comma_ = fields_.back().empty();
    std::vector<std::string> missing;
    for (std::size_t i = 0; i < kRequiredColumns; ++i)
      if (!has(static_cast<ColumnRole>(i))) missing.emplace_back(kColumnNames[i]);
    if (missing.empty()) return true;
    // Usually the file is that of another program, so every message recommends the import.
    LineFault fault = header_fault(line_, fields_, missing);
    fault.text += ", or let palpate import " + label_ + " --out REC.csv do it";
    return fail(fault);
  }

  bool next(RecordingRow& row) {
    if (!next_line()) return finish();
    if (!parse(row)) {
      if (!trimmed(line_).empty())
        return fail(row_fault(line_, line_has_end_, fields_, roles_, header_ends_with_comma_));
      // Blank lines are allowed at the end of the file only.
      const std::string blank = place_of(line_);
      while (next_line())
        if (!trimmed(line_).empty())
          return fail(blank + "found a blank line, expected a row with " + std::to_string(roles_.size()) +
                      " fields; remove the blank line");
      return finish();
    }
    if (rules_.rows() == 0) first_time_ = place_of(value_of(fields_[index_of(ColumnRole::kTime)]));
    const auto fault = rules_.check(row);
    return !fault || fail(*fault);
  }

  bool finish() {
    if (error_) return false;
    const auto fault = rules_.finish();
    return fault && fail(*fault);
  }

  // Parses every field of the present line. If false, row_fault gives the reason.
  bool parse(RecordingRow& row) {
    split_line();
    if (fields_.size() != roles_.size()) return false;
    std::array<double, kKnownColumns> values{};
    for (std::size_t i = 0; i < fields_.size(); ++i)
      if (roles_[i] != ColumnRole::kIgnored && !parse_field(fields_[i], values[static_cast<std::size_t>(roles_[i])]))
        return false;
    row = {values[0], values[1], values[2], values[3], values[4]};
    return true;
  }

  void split_line() {
    fields_.clear();
    for (std::string_view rest = line_;;) {
      const std::size_t comma = rest.find(',');
      fields_.push_back(rest.substr(0, comma));
      if (comma == std::string_view::npos) return;
      rest.remove_prefix(comma + 1);
    }
  }

  std::size_t index_of(ColumnRole role) const {
    return static_cast<std::size_t>(std::find(roles_.begin(), roles_.end(), role) - roles_.begin());
  }
  bool has(ColumnRole role) const { return index_of(role) < roles_.size(); }

  std::istream& stream_;
  std::string label_;
  std::vector<char> buffer_;              // holds the present line
  std::string_view line_;                 // without its line end; empty at the end of the file
  std::vector<std::string_view> fields_;  // of the present line
  std::uint64_t line_number_ = 0;
  bool line_has_end_ = false;      // false: the file ends here without a newline
  std::vector<ColumnRole> roles_;  // of the columns of the file, in its order
  bool header_ends_with_comma_ = false;
  RowRules rules_;
  std::string first_time_;  // the place of the first time
  std::optional<Error> error_;
};

}  // namespace

Result<Recording> read_recording(std::istream& stream, const std::string& label, std::size_t most_rows) {
  return RecordingReader(stream, label).read(most_rows, 0);
}

Result<Recording> read_recording(const std::string& path, std::size_t most_rows) {
  const auto file = open_plain_file(path, "a recording (CSV)");
  if (!file) return file.error();
  std::error_code unknown;  // then the size is the largest number
  const auto bytes = std::filesystem::file_size(path, unknown);
  return RecordingReader(**file, path).read(most_rows, std::min<std::size_t>(bytes / kShortestRow, kMostExpected));
}

Status read_recording_blocks(const std::string& path, std::size_t block_rows,
                             const std::function<void(Recording block)>& use) {
  const auto file = open_plain_file(path, "a recording (CSV)");
  if (!file) return file.error();
  RecordingReader reader(**file, path);
  Result<Recording> block = reader.read(block_rows, block_rows);
  while (block && !block->rows.empty()) {
    Result<Recording> next = Recording{};
    parallel_for(2, [&](int part) {
      if (part == 0)
        next = reader.read(block_rows, block_rows);
      else
        use(std::move(*block));
    });
    block = std::move(next);
  }
  return block ? Status() : block.error();
}

}  // namespace palpate
