#include "models/training/motion_source.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <deque>
#include <future>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "engine/tick/sensor_identification.h"

namespace palpate {
namespace {

// The rows of one input, from memory or from its file, in chunks.
class RowStream {
 public:
  static Result<RowStream> open(const MotionSource::Input& input) {
    RowStream stream;
    stream.loaded_ = input.loaded;
    if (input.loaded) return stream;
    auto reader = RecordingReader::open(input.path);
    if (!reader) return reader.error();
    stream.reader_.emplace(std::move(*reader));
    return stream;
  }

  bool in_memory() const { return loaded_ != nullptr; }
  const std::string& name() const { return loaded_ ? loaded_->name : reader_->name(); }
  RecordingColumns columns() const { return loaded_ ? loaded_->columns : reader_->columns(); }

  // The next rows, as many as fit but at the end, so that files and memory show sensor
  // identification the same; none at the end.
  Result<std::size_t> next(std::vector<RecordingRow>& chunk) {
    if (loaded_) {
      const auto rows = next_in_memory(chunk.size());
      std::copy(rows.begin(), rows.end(), chunk.begin());
      return rows.size();
    }
    std::size_t filled = 0;
    while (filled < chunk.size()) {
      const auto count = reader_->read(chunk.data() + filled, chunk.size() - filled);
      if (!count) return count.error();
      if (*count == 0) break;
      filled += *count;
    }
    return filled;
  }

  // The same where they are.
  std::span<const RecordingRow> next_in_memory(std::size_t most) {
    const auto rows = std::span(loaded_->rows).subspan(position_, std::min(most, loaded_->rows.size() - position_));
    position_ += rows.size();
    return rows;
  }

 private:
  std::shared_ptr<const Recording> loaded_;
  std::optional<RecordingReader> reader_;
  std::size_t position_ = 0;
};

// Files up to this many rows together are read once, when they are put in order.
constexpr std::size_t kRowsReadOnce = 500000;

// The rows of a stream; of a file the next chunk is read while the last one is worked on.
class ReadAhead {
 public:
  ReadAhead(RowStream& stream, std::size_t chunk_rows) : stream_(stream), chunk_rows_(chunk_rows) {
    if (stream_.in_memory()) return;
    ready_.resize(chunk_rows);
    next_.resize(chunk_rows);
    begin();
  }
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;
  ~ReadAhead() {
    if (coming_.valid()) coming_.wait();
  }

  // Empty at the end.
  Result<std::span<const RecordingRow>> next() {
    if (stream_.in_memory()) return stream_.next_in_memory(chunk_rows_);
    const auto count = coming_.get();
    if (!count) return count.error();
    std::swap(ready_, next_);
    if (*count > 0) begin();
    return std::span<const RecordingRow>(ready_.data(), *count);
  }

 private:
  void begin() {
    coming_ = std::async(std::launch::async | std::launch::deferred, [this] { return stream_.next(next_); });
  }

  RowStream& stream_;
  std::size_t chunk_rows_;
  std::vector<RecordingRow> ready_;
  std::vector<RecordingRow> next_;
  std::future<Result<std::size_t>> coming_;
};

// Of a sample: at least so many stretches of a recording where they are not too short.
constexpr std::size_t kStretches = 4;
constexpr std::size_t kShortestStretch = 256;
constexpr std::size_t kLongestStretch = 16384;

// FNV-1a over the numbers of the rows.
class ContentHash {
 public:
  void add(const RecordingRow& row) {
    for (const double value :
         {row.time_s, row.position_m, row.force_N, row.velocity_m_per_s, row.acceleration_m_per_s2}) {
      value_ = (value_ ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001B3ULL;
      value_ ^= value_ >> 29;
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325ULL;
};

struct ArrangedInput {
  std::size_t rows = 0;
  std::uint64_t hash = 0;
  std::string name;
  MotionSource::Input input;
};

// Rows moved by their recording's correction, contacts counted as they are then.
class CorrectedRows {
 public:
  explicit CorrectedRows(const std::vector<RowCorrection>& corrections) : corrections_(corrections) {}

  // Visits the rows that `recorded` completes: it itself, or, with a lag, those whose force
  // comes with it. False when a visit says so.
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
    return row_;
  }

  const std::vector<RowCorrection>& corrections_;
  std::deque<MotionRow> waiting_;
  std::deque<std::pair<double, double>> forces_;  // s, N
  bool first_ = true;
  MotionRow row_;
  int stroke_ = 0;
  bool was_in_contact_ = false;
};

}  // namespace

Status MotionSource::arrange(const FitControl& control, double fraction) {
  if (inputs_.size() < 2) return {};
  std::vector<ArrangedInput> arranged;
  std::vector<RecordingRow> chunk(kRowsPerQuestion);
  std::size_t held = 0;
  for (Input& input : inputs_) {
    auto stream = RowStream::open(input);
    if (!stream) return stream.error();
    auto copy = std::make_shared<Recording>(Recording{stream->name(), stream->columns(), {}});
    ArrangedInput one{0, 0, stream->name(), input};
    ContentHash hash;
    while (true) {
      const auto count = stream->next(chunk);
      if (!count) return count.error();
      if (*count == 0) break;
      for (std::size_t i = 0; i < *count; ++i) hash.add(chunk[i]);
      one.rows += *count;
      if (!input.loaded && held + one.rows <= std::min(kRowsReadOnce, kept_rows_)) {
        copy->rows.insert(copy->rows.end(), chunk.begin(), chunk.begin() + static_cast<std::ptrdiff_t>(*count));
      }
      if (!control.may_continue(fraction)) return interrupted();
    }
    one.hash = hash.value();
    if (!input.loaded && copy->rows.size() == one.rows) {
      held += one.rows;
      one.input.loaded = std::move(copy);
    }
    arranged.push_back(std::move(one));
  }
  // The longest first, then by content; equal recordings by name.
  std::stable_sort(arranged.begin(), arranged.end(), [](const ArrangedInput& a, const ArrangedInput& b) {
    return std::tie(b.rows, a.hash, a.name) < std::tie(a.rows, b.hash, b.name);
  });
  for (std::size_t i = 0; i < arranged.size(); ++i) inputs_[i] = std::move(arranged[i].input);
  return {};
}

void MotionSource::forget() {
  kept_.clear();
  spilled_.reset();
  keeps_ = false;
}

// In memory, from the first row too many on in a file.
void MotionSource::keep(const MotionRow& row) {
  if (!keeps_) return;
  if (!spilled_ && kept_.size() < kept_rows_) return kept_.push_back(row);
  const auto spill = [&](const MotionRow& one) { return spilled_->add({one.sample, one.motion, one.force_N}); };
  if (!spilled_) {
    spilled_ = SpilledRows::create();
    const bool moved = spilled_ && std::all_of(kept_.begin(), kept_.end(), spill);
    kept_.clear();
    kept_.shrink_to_fit();
    if (!moved) return forget();
  }
  if (!spill(row)) forget();
}

Status MotionSource::read_spilled(const std::function<bool(const MotionRow&)>& visit) const {
  std::vector<SpilledRows::Row> chunk(kRowsPerQuestion);
  MotionRow row;
  row.recording = -1;
  for (std::size_t at = 0; at < spilled_->count(); at += chunk.size()) {
    chunk.resize(std::min(chunk.size(), spilled_->count() - at));
    if (Status status = spilled_->read(at, chunk); !status) return status;
    for (std::size_t i = 0; i < chunk.size(); ++i) {
      const auto next = static_cast<std::size_t>(row.recording + 1);
      row.first = next < first_rows_.size() && first_rows_[next] == at + i;
      if (row.first) ++row.recording;
      row.sample = chunk[i].sample;
      row.motion = chunk[i].motion;
      row.force_N = chunk[i].force_N;
      if (!visit(row)) return interrupted();
    }
  }
  return {};
}

// Whether all rows and their motion are in memory as they came.
bool MotionSource::knows_all() const {
  return std::all_of(inputs_.begin(), inputs_.end(),
                     [](const Input& input) { return input.loaded != nullptr && input.motion != nullptr; });
}

Status MotionSource::visit_loaded(const std::function<bool(const MotionRow&)>& visit) const {
  MotionRow row;
  for (std::size_t index = 0; index < inputs_.size(); ++index) {
    const auto& rows = inputs_[index].loaded->rows;
    const auto& motion = *inputs_[index].motion;
    row.recording = static_cast<int>(index);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      row.first = i == 0;
      row.sample = tool_sample(rows[i]);
      row.motion = motion[i];
      row.force_N = rows[i].force_N;
      if (!visit(row)) return interrupted();
    }
  }
  return {};
}

Status MotionSource::read_all(const std::function<bool(const MotionRow&)>& visit) {
  names_.clear();
  first_rows_.clear();
  forget();  // what a pass that broke off has left
  const bool known_before = knows_all();
  keeps_ = !known_before;
  rows_ = 0;
  std::size_t loaded = 0;
  for (const Input& input : inputs_) loaded += input.loaded ? input.loaded->rows.size() : kept_rows_;
  if (keeps_) kept_.reserve(std::min(loaded, kept_rows_));  // what stays untouched takes no memory
  MotionRow row;
  for (std::size_t index = 0; index < inputs_.size(); ++index) {
    auto stream = RowStream::open(inputs_[index]);
    if (!stream) return stream.error();
    names_.push_back(stream->name());
    row.recording = static_cast<int>(index);
    row.first = true;
    std::optional<MotionEstimator> estimator;
    const MotionEstimate* known = inputs_[index].motion ? inputs_[index].motion->data() : nullptr;
    // One chunk is what sensor identification looks at.
    ReadAhead chunks(*stream, kSensorIdentificationRows);
    while (true) {
      const auto chunk = chunks.next();
      if (!chunk) return chunk.error();
      if (chunk->empty()) break;
      if (!estimator) {
        const SensorSpec sensor = identify_sensor(chunk->data(), chunk->size(), stream->columns());
        estimator.emplace(sensor);
        std::tie(encoder_step_m_, position_noise_m_) = std::max(
            std::pair{encoder_step_m_, position_noise_m_}, std::pair{sensor.encoder_step_m, sensor.position_noise_m});
        force_noise_N_ = std::max(force_noise_N_, identify_force_noise_N(chunk->data(), chunk->size()));
      }
      for (const RecordingRow& recorded : *chunk) {
        row.sample = tool_sample(recorded);
        row.force_N = recorded.force_N;
        row.motion = known != nullptr ? *known++ : estimator->update(row.sample);
        if (row.first) first_rows_.push_back(rows_);
        keep(row);
        ++rows_;
        if (!visit(row)) {
          forget();
          return interrupted();
        }
        row.first = false;
      }
    }
  }
  if (spilled_ && !spilled_->finish()) forget();
  complete_ = keeps_ || known_before;
  return {};
}

Status MotionSource::for_each(const std::function<bool(const MotionRow&)>& visit, const FitControl& control,
                              double fraction) {
  if (!arranged_) {
    if (Status status = arrange(control, fraction); !status) return status;
    arranged_ = true;
  }
  std::size_t seen = 0;
  CorrectedRows corrected(corrections_);
  return visit_recorded([&](const MotionRow& row) {
    return corrected.feed(row, visit) && (++seen % kRowsPerQuestion != 0 || control.may_continue(fraction));
  });
}

Status MotionSource::visit_recorded(const std::function<bool(const MotionRow&)>& visit) {
  if (!complete_) return read_all(visit);
  if (spilled_) return read_spilled(visit);
  if (kept_.empty() && !inputs_.empty() && knows_all()) return visit_loaded(visit);
  for (const MotionRow& row : kept_) {
    if (!visit(row)) return interrupted();
  }
  return {};
}

Result<MotionSource> MotionSource::sample(std::size_t most, const FitControl& control, double fraction) {
  // Half of them in stretches, half on the way to these.
  const std::size_t sparse = 2 * rows_ / most + 1;
  const std::size_t mean_rows = rows_ / std::max<std::size_t>(1, names_.size());
  const std::size_t stretch = std::clamp(mean_rows / (kStretches * sparse), kShortestStretch, kLongestStretch);
  MotionSource result({}, most);
  std::size_t at = 0;  // in its recording
  std::size_t seen = 0;
  const Status status = visit_recorded([&](const MotionRow& row) {
    if (row.first) at = 0;
    const bool in_stretch = at % (sparse * stretch) < stretch;
    if (in_stretch || at % sparse == 0) {
      result.kept_.push_back(row);
      result.kept_.back().run_up = !in_stretch;
    }
    ++at;
    return ++seen % kRowsPerQuestion != 0 || control.may_continue(fraction);
  });
  if (!status) return status.error();
  result.names_ = names_;
  result.corrections_ = corrections_;
  result.rows_ = result.kept_.size();
  result.force_noise_N_ = force_noise_N_;
  result.encoder_step_m_ = encoder_step_m_;
  result.position_noise_m_ = position_noise_m_;
  result.arranged_ = result.complete_ = true;
  return result;
}

}  // namespace palpate
