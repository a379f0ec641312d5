#include "devices/virtual/simulated_devices.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/tick/sensor_identification.h"

namespace palpate {

// A longer gap between ticks is a stall; the replay advances by this at most.
constexpr double kLongestReplayStep_s = 0.1;

ReplayDevice::ReplayDevice(Recording recording)
    : name_("replay:" + recording.name),
      recording_(std::move(recording)),
      sensor_(identify_sensor(recording_.rows.data(), recording_.rows.size(), recording_.columns)) {}

void ReplayDevice::set_speed(double speed) noexcept {
  if (!std::isfinite(speed)) return;
  speed_.store(std::clamp(speed, kSlowestReplay, kFastestReplay), std::memory_order_relaxed);
}

void ReplayDevice::seek(double at_s) noexcept {
  if (!std::isfinite(at_s)) return;
  seek_s_.store(std::clamp(at_s, 0.0, duration_s()), std::memory_order_relaxed);
}

void ReplayDevice::step(int rows) noexcept {
  pause(true);
  rows_.fetch_add(rows, std::memory_order_relaxed);
}

void ReplayDevice::move_surface(double offset_m) noexcept {
  if (std::isfinite(offset_m)) surface_offset_m_.store(offset_m, std::memory_order_relaxed);
}

void ReplayDevice::go_to(double at_s) noexcept {
  const double time_s = recording_.rows.front().time_s + at_s;
  const auto row = std::lower_bound(recording_.rows.begin(), recording_.rows.end(), time_s,
                                    [](const RecordingRow& a, double time) { return a.time_s < time; });
  next_ = std::min(static_cast<std::size_t>(row - recording_.rows.begin()), recording_.rows.size() - 1);
  // The playhead is at the row exactly, so that the row is read even while paused.
  playhead_s_ = time_of(next_);
  restart_ = true;
}

// `next_` is the row after the one that was read last.
void ReplayDevice::go_by(int rows) noexcept {
  const auto last = static_cast<long>(recording_.rows.size()) - 1;
  const long row = std::clamp(static_cast<long>(next_) - 1 + rows, 0L, last);
  playhead_s_ = time_of(static_cast<std::size_t>(row));
  if (rows < 0) go_to(playhead_s_);
}

void ReplayDevice::move_playhead(double now_s) noexcept {
  const double step_s = started_ ? std::clamp(now_s - now_s_, 0.0, kLongestReplayStep_s) : 0.0;
  started_ = true;
  now_s_ = now_s;
  handed_over_ = 0;
  if (const double offset_m = surface_offset_m(); offset_m != moved_m_) {
    moved_m_ = offset_m;
    go_to(std::min(playhead_s_, duration_s()));
  }
  const double seek_s = seek_s_.exchange(-1.0, std::memory_order_relaxed);
  const int rows = rows_.exchange(0, std::memory_order_relaxed);
  if (seek_s >= 0.0) {
    go_to(seek_s);
  } else if (rows != 0) {
    go_by(rows);
  } else if (!paused()) {
    playhead_s_ += step_s * speed();
    if (next_ == recording_.rows.size()) go_to(0.0);
  }
  shown_s_.store(std::min(playhead_s_, duration_s()), std::memory_order_relaxed);
}

bool ReplayDevice::read(double now_s, DeviceSample& sample) noexcept {
  if (!started_ || now_s > now_s_) move_playhead(now_s);
  if (next_ == recording_.rows.size()) return false;
  const double due_s = time_of(next_);
  if (due_s > playhead_s_) return false;
  // The loop reads no more samples in this tick, so the playhead waits.
  if (++handed_over_ == kMaxSamplesPerTick) playhead_s_ = due_s;
  const RecordingRow& row = recording_.rows[next_];
  sample = {};
  sample.tool = tool_sample(row);
  sample.tool.position_m -= moved_m_;
  sample.measured_N = row.force_N;
  sample.restart = restart_;
  restart_ = false;
  ++next_;
  return true;
}

}  // namespace palpate
