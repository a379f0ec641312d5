#include "scenes/live/session_recorder.h"

#include <chrono>
#include <cmath>
#include <system_error>
#include <utility>

#include "engine/base/text.h"

namespace palpate {
namespace {

constexpr std::size_t kSamplesAtOnce = 1024;
constexpr auto kPause = std::chrono::milliseconds(20);
constexpr int kRoundsToDisk = 10;  // rows are written to the disk after so many rounds

// The force to record, indexed by ReferenceKind.
constexpr double RecordedSample::*kForces[] = {&RecordedSample::measured_N, &RecordedSample::reference_N,
                                               &RecordedSample::model_N};

std::string counted(std::uint64_t count, const char* words) {
  return count > 0 ? "; " + std::to_string(count) + " samples " + words : std::string();
}

}  // namespace

std::optional<double> RecordingTime::file_time_s(double time_s, bool restart) noexcept {
  if (!started_) origin_s_ = time_s;
  double at_s = start_s_ + (time_s - origin_s_);
  if (started_ && !(at_s > last_s_)) {
    if (!restart) return std::nullopt;
    at_s = start_s_ = last_s_ + kStreamGap_s;
    gaps_s_ += kStreamGap_s;
    origin_s_ = time_s;
  }
  started_ = true;
  last_s_ = at_s;
  return at_s;
}

SessionRecorder::SessionRecorder(HapticsLoop& loop) : loop_(loop), buffer_(kSamplesAtOnce) {}

SessionRecorder::~SessionRecorder() {
  stop();
  wait();
}

Status SessionRecorder::start(const RecorderRequest& request) {
  if (running_.valid()) return Error{"already recording into " + request_.path + "; stop that one first"};
  Result<RecordingWriter> writer =
      RecordingWriter::create(request.path, request.columns, request.comments, request.overwrite, true);
  if (!writer) return writer.error();
  writer_.emplace(std::move(*writer));
  request_ = request;
  ++number_;
  time_ = {};
  without_force_ = unusable_ = 0;
  restart_pending_ = false;
  dropped_before_ = loop_.recorded().dropped();
  rows_.store(0, std::memory_order_relaxed);
  seconds_.store(0.0, std::memory_order_relaxed);
  stop_ = false;
  try {
    running_ = std::async(std::launch::async, [this] { return work(); });
  } catch (const std::system_error& error) {
    writer_.reset();
    return Error{std::string("cannot start the recorder's thread: ") + error.what() + "; close other programs"};
  }
  return {};
}

Notice SessionRecorder::work() {
  int rounds = 0;
  for (bool last = false; !last && !writer_->failed();) {
    static_cast<void>(wake_.try_acquire_for(kPause));
    last = stop_;
    drain();
    // A write error is persistent: this loop ends, and `finish` reports it.
    if (++rounds % kRoundsToDisk == 0) static_cast<void>(writer_->flush());
  }
  Notice outcome = finish();
  writer_.reset();
  return outcome;
}

void SessionRecorder::drain() {
  // Reads at most as many samples as the ring holds, so that `stop` ends even if the loop fills the ring faster than
  // the disk takes it.
  for (std::size_t round = 0; round <= kRecordedRing / kSamplesAtOnce; ++round) {
    const std::size_t count = loop_.recorded().pop(buffer_.data(), buffer_.size());
    for (std::size_t i = 0; i < count; ++i) write(buffer_[i]);
    if (count < buffer_.size()) break;
  }
  rows_.store(writer_->rows(), std::memory_order_relaxed);
  seconds_.store(time_.last_s() - time_.gaps_s(), std::memory_order_relaxed);
}

void SessionRecorder::write(const RecordedSample& sample) {
  // The ring may still hold samples of an earlier recording.
  if (sample.recording != number_) return;
  restart_pending_ = restart_pending_ || sample.restart;
  if (!sample.usable || !std::isfinite(sample.tool.time_s)) {
    ++unusable_;
    return;
  }
  const double force_N = request_.columns.force ? sample.*kForces[static_cast<std::size_t>(request_.force)] : 0.0;
  if (!std::isfinite(force_N)) {
    ++without_force_;
    return;
  }
  const std::optional<double> time_s = time_.file_time_s(sample.tool.time_s, restart_pending_);
  restart_pending_ = false;
  if (!time_s) {
    ++unusable_;
    return;
  }
  const ToolSample& tool = sample.tool;
  if (!writer_->add({*time_s, tool.position_m, force_N, tool.velocity_m_per_s, tool.acceleration_m_per_s2}))
    ++unusable_;
}

Notice SessionRecorder::finish() {
  const std::uint64_t dropped = loop_.recorded().dropped() - dropped_before_;
  const Status status = writer_->commit();
  if (!status && writer_->flushed_rows() == 0) return {"the recording was lost: " + status.error().message, true};
  if (!status) {
    return {"the recording ended early: " + status.error().message + "; " + AtomicFile::part_of(request_.path) +
                " has its first " + std::to_string(writer_->flushed_rows()) +
                " rows; make room, and record the rest into another file",
            true};
  }
  return {"recorded " + std::to_string(writer_->rows()) + " rows (" + fixed(time_.last_s() - time_.gaps_s(), 1) +
              " s) into " + request_.path + counted(dropped, "were lost because the disk was too slow") +
              counted(unusable_, "that the loop could not use were left out") +
              counted(without_force_, "without a force were left out") +
              (time_.gaps_s() > 0.0 ? "; the time of the device began again, after gaps of " +
                                          general(time_.gaps_s(), 3) + " s in all that were not measured"
                                    : ""),
          dropped > 0};
}

RecordingStatus SessionRecorder::status() const {
  if (!running_.valid()) return {};
  return {!stop_, stop_, request_.path, rows_.load(std::memory_order_relaxed),
          seconds_.load(std::memory_order_relaxed)};
}

std::optional<Notice> SessionRecorder::read_outcome() {
  if (!running_.valid() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::nullopt;
  return running_.get();
}

}  // namespace palpate
