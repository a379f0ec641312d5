#include "models/training/motion_source.h"

#include <algorithm>
#include <optional>
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

  const std::string& name() const { return loaded_ ? loaded_->name : reader_->name(); }
  RecordingColumns columns() const { return loaded_ ? loaded_->columns : reader_->columns(); }

  // The next chunk, full but for the last one, so that files and memory show
  // sensor identification the same rows; empty at the end.
  Result<std::size_t> next(std::vector<RecordingRow>& chunk) {
    if (!loaded_) return next_from_file(chunk);
    const std::size_t count = std::min(chunk.size(), loaded_->rows.size() - position_);
    std::copy_n(loaded_->rows.begin() + static_cast<std::ptrdiff_t>(position_), count, chunk.begin());
    position_ += count;
    return count;
  }

 private:
  Result<std::size_t> next_from_file(std::vector<RecordingRow>& chunk) {
    std::size_t filled = 0;
    while (filled < chunk.size()) {
      const auto count = reader_->read(chunk.data() + filled, chunk.size() - filled);
      if (!count) return count.error();
      if (*count == 0) break;
      filled += *count;
    }
    return filled;
  }

  std::shared_ptr<const Recording> loaded_;
  std::optional<RecordingReader> reader_;
  std::size_t position_ = 0;
};

}  // namespace

Status MotionSource::read_all(const std::function<bool(const MotionRow&)>& visit) {
  names_.clear();
  kept_.clear();  // of a pass that broke off
  rows_ = 0;
  bool keep = true;
  // One chunk is what sensor identification looks at.
  std::vector<RecordingRow> chunk(kSensorIdentificationRows);
  MotionRow row;
  bool was_in_contact = false;
  for (std::size_t index = 0; index < inputs_.size(); ++index) {
    auto stream = RowStream::open(inputs_[index]);
    if (!stream) return stream.error();
    names_.push_back(stream->name());
    row.recording = static_cast<int>(index);
    row.first = true;
    std::optional<MotionEstimator> estimator;
    while (true) {
      const auto count = stream->next(chunk);
      if (!count) return count.error();
      if (*count == 0) break;
      if (!estimator) {
        estimator.emplace(identify_sensor(chunk.data(), *count, stream->columns()));
        force_noise_N_ = std::max(force_noise_N_, identify_force_noise_N(chunk.data(), *count));
      }
      for (std::size_t i = 0; i < *count; ++i) {
        row.sample = tool_sample(chunk[i]);
        row.force_N = chunk[i].force_N;
        row.motion = estimator->update(row.sample);
        const bool in_contact = row.sample.position_m > 0.0;
        if (in_contact && (row.first || !was_in_contact)) ++row.stroke;
        was_in_contact = in_contact;
        if (keep && kept_.size() == kept_rows_) {
          keep = false;
          kept_.clear();
          kept_.shrink_to_fit();
        }
        if (keep) kept_.push_back(row);
        ++rows_;
        if (!visit(row)) {
          kept_.clear();
          return interrupted();
        }
        row.first = false;
      }
    }
  }
  complete_ = keep;
  return {};
}

Status MotionSource::for_each(const std::function<bool(const MotionRow&)>& visit, const FitControl& control,
                              double fraction) {
  std::size_t seen = 0;
  const auto visit_and_ask = [&](const MotionRow& row) {
    return visit(row) && (++seen % kRowsPerQuestion != 0 || control.go_on(fraction));
  };
  if (!complete_) return read_all(visit_and_ask);
  for (const MotionRow& row : kept_) {
    if (!visit_and_ask(row)) return interrupted();
  }
  return {};
}

}  // namespace palpate
