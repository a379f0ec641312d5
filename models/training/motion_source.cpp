#include "models/training/motion_source.h"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "engine/recording/recording.h"
#include "engine/tick/sensor_identification.h"

namespace palpate {
namespace {

// Reads the rows of one input, from memory or from its file, in chunks.
class RowStream {
 public:
  static Result<RowStream> open(const MotionSource::Input& input) {
    RowStream stream;
    stream.prepared_ = input.prepared.get();
    if (input.prepared) return stream;
    auto reader = RecordingReader::open(input.path);
    if (!reader) return reader.error();
    stream.reader_.emplace(std::move(*reader));
    stream.chunk_.resize(kSensorIdentificationRows);
    return stream;
  }

  const std::string& name() const { return prepared_ != nullptr ? prepared_->recording.name : reader_->name(); }
  RecordingColumns columns() const { return prepared_ != nullptr ? prepared_->recording.columns : reader_->columns(); }

  // The next kSensorIdentificationRows rows, fewer only at the end, so that the identification of the sensor gets the
  // same rows from a file as from memory. Empty at the end.
  Result<std::span<const RecordingRow>> next() {
    if (prepared_ != nullptr) {
      const auto rows = std::span(prepared_->recording.rows).subspan(position_);
      const auto some = rows.first(std::min(kSensorIdentificationRows, rows.size()));
      position_ += some.size();
      return some;
    }
    std::size_t filled = 0;
    while (filled < chunk_.size()) {
      const auto count = reader_->read(chunk_.data() + filled, chunk_.size() - filled);
      if (!count) return count.error();
      if (*count == 0) break;
      filled += *count;
    }
    return std::span<const RecordingRow>(chunk_.data(), filled);
  }

 private:
  const PreparedRecording* prepared_ = nullptr;
  std::optional<RecordingReader> reader_;
  std::vector<RecordingRow> chunk_;
  std::size_t position_ = 0;
};

// Of a long recording stretches of consecutive rows are kept: kStretches or more, unless that makes them too short.
constexpr std::size_t kStretches = 4;
constexpr std::size_t kShortestStretch = 256;
constexpr std::size_t kLongestStretch = 16384;

// Applies the corrections to the rows and counts contacts by the corrected position.
class CorrectedRows {
 public:
  CorrectedRows(const std::vector<RowCorrection>& corrections, const std::optional<FoldAssignment>& assignment)
      : corrections_(corrections), assignment_(assignment) {}

  // Visits the rows whose force is known with `recorded`: the row itself or, with a lag, earlier rows. Returns false
  // when a visit does.
  template <typename Visit>
  bool feed(const MotionRow& recorded, const Visit& visit) {
    const double lag_s = corrections_.empty() ? 0.0 : corrections_[static_cast<std::size_t>(recorded.recording)].lag_s;
    if (lag_s == 0.0) return visit(moved(recorded));
    if (recorded.first) {
      waiting_.clear();
      forces_.clear();
      first_ = true;
    }
    waiting_.push_back(recorded);
    forces_.push_back({recorded.sample.time_s, recorded.force_N});
    while (!waiting_.empty()) {
      MotionRow row = waiting_.front();
      const double wanted_s = row.sample.time_s + lag_s;
      if (forces_.back().first < wanted_s) break;
      while (forces_.size() > 2 && forces_[1].first <= wanted_s) forces_.pop_front();
      waiting_.pop_front();
      if (wanted_s < forces_.front().first || forces_.size() < 2) continue;
      const auto& [from_s, from_N] = forces_[0];
      const auto& [to_s, to_N] = forces_[1];
      row.force_N = from_N + (to_N - from_N) * (wanted_s - from_s) / (to_s - from_s);
      row.first = std::exchange(first_, false);
      if (!visit(moved(row))) return false;
    }
    return true;
  }

 private:
  const MotionRow& moved(const MotionRow& recorded) {
    row_ = recorded;
    if (!corrections_.empty()) {
      const RowCorrection& correction = corrections_[static_cast<std::size_t>(recorded.recording)];
      row_.sample.position_m -= correction.offset_m;
      row_.motion.position_m -= correction.offset_m;
      row_.force_N -= correction.force_zero_N;
    }
    const bool in_contact = row_.sample.position_m > 0.0;
    if (in_contact && (recorded.first || !was_in_contact_)) ++stroke_;
    was_in_contact_ = in_contact;
    row_.stroke = stroke_;
    if (assignment_) row_.fold = assignment_->next(row_.recording, stroke_, in_contact);
    return row_;
  }

  const std::vector<RowCorrection>& corrections_;
  std::optional<FoldAssignment> assignment_;
  std::deque<MotionRow> waiting_;
  std::deque<std::pair<double, double>> forces_;  // s, N
  bool first_ = true;
  MotionRow row_;
  int stroke_ = 0;
  bool was_in_contact_ = false;
};

}  // namespace

Status MotionSource::read(const Input& input, const Thinning& thinning, OneRecording& one, const FitControl& control,
                          double fraction) {
  auto stream = RowStream::open(input);
  if (!stream) return stream.error();
  one.name = stream->name();
  one.recorded = 0;
  ContentHash hash;
  std::optional<MotionEstimator> estimator;
  const PreparedRecording* prepared = one.prepared = input.prepared.get();
  const MotionEstimate* known = prepared != nullptr && !prepared->motion.empty() ? prepared->motion.data() : nullptr;
  if (prepared != nullptr) one.rows.reserve(std::min(prepared->recording.rows.size(), most_rows_));
  while (true) {
    const auto chunk = stream->next();
    if (!chunk) return chunk.error();
    if (chunk->empty()) break;
    if (!estimator) {
      const SensorSpec sensor =
          prepared != nullptr ? prepared->sensor : identify_sensor(chunk->data(), chunk->size(), stream->columns());
      estimator.emplace(sensor);
      std::tie(encoder_step_m_, position_noise_m_) = std::max(
          std::pair{encoder_step_m_, position_noise_m_}, std::pair{sensor.encoder_step_m, sensor.position_noise_m});
      force_noise_N_ =
          std::max(force_noise_N_, prepared != nullptr ? prepared->force_noise_N
                                                       : identify_force_noise_N(chunk->data(), chunk->size()));
    }
    for (const RecordingRow& recorded : *chunk) {
      if (prepared == nullptr) hash.add(recorded);
      MotionRow row;
      row.sample = tool_sample(recorded);
      row.force_N = recorded.force_N;
      row.motion = known != nullptr ? *known++ : estimator->update(row.sample);
      row.first = one.recorded == 0;
      const bool between = thinning.is_run_up(one.recorded);
      row.run_up = between || (prepared != nullptr && !prepared->left_out.empty() && prepared->left_out[one.recorded]);
      if (!between || one.recorded % thinning.sparse == 0) one.rows.push_back(row);
      ++one.recorded;
    }
    // A recording that is too long is read again, thinned.
    if (thinning.sparse == 1 && one.rows.size() > most_rows_) one.rows.clear();
    if (!control.may_continue(fraction)) return interrupted();
  }
  one.hash = prepared != nullptr ? prepared->content_hash : hash.value();
  return {};
}

Status MotionSource::load(const FitControl& control, double fraction) {
  recordings_.assign(inputs_.size(), {});
  rows_ = 0;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if (Status status = read(inputs_[i], {}, recordings_[i], control, fraction); !status) return status;
    rows_ += recordings_[i].recorded;
    for (OneRecording& one : recordings_) {
      if (rows_ > most_rows_) one.rows = {};
    }
  }
  if (rows_ > most_rows_) {
    // Of `most_rows_` a quarter is at the beginnings, up to a third in stretches and up to a third in run-ups.
    Thinning thinning{most_rows_ / (4 * inputs_.size()), 3 * rows_ / most_rows_ + 1, 0};
    const std::size_t mean_rows = rows_ / inputs_.size();
    thinning.stretch = std::clamp(mean_rows / (kStretches * thinning.sparse), kShortestStretch, kLongestStretch);
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      if (Status status = read(inputs_[i], thinning, recordings_[i], control, fraction); !status) return status;
    }
  }
  // By descending length, then by the hash of the content, then by name.
  std::stable_sort(recordings_.begin(), recordings_.end(), [](const OneRecording& a, const OneRecording& b) {
    return std::tie(b.recorded, a.hash, a.name) < std::tie(a.recorded, b.hash, b.name);
  });
  for (std::size_t i = 0; i < recordings_.size(); ++i) {
    names_.push_back(recordings_[i].name);
    hashes_.push_back(recordings_[i].hash);
    for (MotionRow& row : recordings_[i].rows) row.recording = static_cast<int>(i);
  }
  return {};
}

Status MotionSource::for_each(const std::function<bool(const MotionRow&)>& visit, const FitControl& control,
                              double fraction) {
  if (names_.empty()) {
    if (Status status = load(control, fraction); !status) return status;
  }
  std::size_t seen = 0;
  CorrectedRows corrected(corrections_, assignment_);
  for (const OneRecording& one : recordings_) {
    for (const MotionRow& row : one.rows) {
      if (!corrected.feed(row, visit)) return interrupted();
      if (++seen % kRowsPerQuestion == 0 && !control.may_continue(fraction)) return interrupted();
    }
  }
  return {};
}

}  // namespace palpate
