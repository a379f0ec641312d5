#include "engine/recording/recording.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <string_view>
#include <tuple>

#include "engine/base/statistics.h"
#include "engine/base/text.h"
#include "engine/base/whole_file.h"

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

std::uint64_t content_hash(const Recording& recording) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
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

constexpr std::uint64_t kMostNotes = 20;

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
  return RecordingWriter(std::move(*file), path, columns, overwrite);
}

Status RecordingWriter::add(const RecordingRow& row) {
  if (const auto fault = rules_.check(row))
    return Error{path_ + ": cannot write row " + std::to_string(rules_.rows() + 1) + ": " + fault->text};
  const auto values = column_values(row);
  file_.write(line_of(columns_, [&](std::size_t i) { return shortest(values[i]); }));
  return {};
}

void RecordingWriter::note(const std::string& comment) {
  if (++noted_ <= kMostNotes) append_comment(notes_, comment);
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
  if (notes_.empty()) return file_.commit();
  if (noted_ > kMostNotes) append_comment(notes_, std::to_string(noted_ - kMostNotes) + " more such notes");
  if (const Status flushed = flush(); !flushed) return flushed;
  const auto rows =
      read_plain_file(AtomicFile::part_of(path_), "the recording", "", std::numeric_limits<std::size_t>::max());
  if (!rows || !write_file_atomically(path_, notes_ + *rows, overwrite_)) return file_.commit();
  const AtomicFile copied = std::move(file_);
  return {};
}

}  // namespace palpate
