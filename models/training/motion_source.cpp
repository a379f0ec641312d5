#include "models/training/motion_source.h"

#include <algorithm>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "engine/recording/recording.h"
#include "engine/tick/sensor_identification.h"

namespace palpate {
namespace {

// Of a long recording stretches of consecutive rows are kept: kStretches or more, unless that makes them too short.
constexpr std::size_t kStretches = 4;
constexpr std::size_t kShortestStretch = 256;
constexpr std::size_t kLongestStretch = 16384;

}  // namespace

Status MotionSource::read(const Input& input, const Thinning& thinning, OneRecording& one, const FitControl& control,
                          double fraction) {
  const PreparedRecording* prepared = one.prepared = input.prepared.get();
  std::optional<RecordingReader> reader;
  if (prepared == nullptr) {
    auto opened = RecordingReader::open(input.path);
    if (!opened) return opened.error();
    reader.emplace(std::move(*opened));
  }
  // The next kSensorIdentificationRows rows, fewer only at the end, so that the identification of the sensor gets the
  // same rows from a file as from memory. Empty at the end.
  std::vector<RecordingRow> chunk_of_file(reader ? kSensorIdentificationRows : 0);
  std::size_t position = 0;
  const auto next = [&]() -> Result<std::span<const RecordingRow>> {
    if (prepared != nullptr) {
      const auto rows = std::span(prepared->recording.rows).subspan(position);
      const auto some = rows.first(std::min(kSensorIdentificationRows, rows.size()));
      position += some.size();
      return some;
    }
    std::size_t filled = 0;
    while (filled < chunk_of_file.size()) {
      const auto count = reader->read(chunk_of_file.data() + filled, chunk_of_file.size() - filled);
      if (!count) return count.error();
      if (*count == 0) break;
      filled += *count;
    }
    return std::span<const RecordingRow>(chunk_of_file.data(), filled);
  };
  one.name = reader ? reader->name() : prepared->recording.name;
  one.recorded = 0;
  ContentHash hash;
  std::optional<MotionEstimator> estimator;
  const MotionEstimate* known = prepared != nullptr && !prepared->motion.empty() ? prepared->motion.data() : nullptr;
  if (prepared != nullptr) one.rows.reserve(std::min(prepared->recording.rows.size(), most_rows_));
  while (true) {
    const auto chunk = next();
    if (!chunk) return chunk.error();
    if (chunk->empty()) break;
    if (!estimator) {
      const SensorSpec sensor =
          prepared != nullptr ? prepared->sensor : identify_sensor(chunk->data(), chunk->size(), reader->columns());
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
  if (!recordings_.empty()) return {};
  std::vector<OneRecording> read_so_far(inputs_.size());
  rows_ = 0;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if (Status status = read(inputs_[i], {}, read_so_far[i], control, fraction); !status) return status;
    rows_ += read_so_far[i].recorded;
    for (OneRecording& one : read_so_far) {
      if (rows_ > most_rows_) one.rows = {};
    }
  }
  if (rows_ > most_rows_) {
    // Of `most_rows_` a quarter is at the beginnings, up to a third in stretches and up to a third in run-ups.
    Thinning thinning{most_rows_ / (4 * inputs_.size()), 3 * rows_ / most_rows_ + 1, 0};
    const std::size_t mean_rows = rows_ / inputs_.size();
    thinning.stretch = std::clamp(mean_rows / (kStretches * thinning.sparse), kShortestStretch, kLongestStretch);
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      if (Status status = read(inputs_[i], thinning, read_so_far[i], control, fraction); !status) return status;
    }
  }
  // By descending length, then by the hash of the content, then by name.
  std::stable_sort(read_so_far.begin(), read_so_far.end(), [](const OneRecording& a, const OneRecording& b) {
    return std::tie(b.recorded, a.hash, a.name) < std::tie(a.recorded, b.hash, b.name);
  });
  recordings_ = std::move(read_so_far);
  return {};
}

Status MotionSource::for_each(const std::function<bool(const MotionRow&)>& visit, const FitControl& control,
                              double fraction) {
  if (Status status = load(control, fraction); !status) return status;
  std::size_t seen = 0;
  int stroke = 0;
  std::optional<FoldAssignment> assignment = assignment_;
  for (std::size_t r = 0; r < recordings_.size(); ++r) {
    const RowCorrection correction = corrections_.empty() ? RowCorrection{} : corrections_[r];
    bool first = true;
    bool was_in_contact = false;
    std::size_t at = 0;
    for (MotionRow row : recordings_[r].rows) {
      if (seen > 0 && seen % kRowsPerQuestion == 0 && !control.may_continue(fraction)) return interrupted();
      ++seen;
      if (correction.lag_s != 0.0) {
        const auto force_N = force_at(recordings_[r].rows, row.sample.time_s + correction.lag_s, at);
        if (!force_N) continue;
        row.force_N = *force_N;
      }
      row.sample.position_m -= correction.offset_m;
      row.motion.position_m -= correction.offset_m;
      row.force_N -= correction.force_zero_N;
      const bool in_contact = row.sample.position_m > 0.0;
      if (in_contact && !was_in_contact) ++stroke;
      was_in_contact = in_contact;
      row.recording = static_cast<int>(r);
      row.first = std::exchange(first, false);
      row.stroke = stroke;
      if (assignment) row.fold = assignment->next(row.recording, stroke, in_contact);
      if (!visit(row)) return interrupted();
    }
  }
  return {};
}

}  // namespace palpate
