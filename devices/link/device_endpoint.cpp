#include "devices/link/device_endpoint.h"

#include <algorithm>
#include <cmath>

namespace palpate {

DeviceEndpoint::DeviceEndpoint(const DeviceCalibration& calibration, std::string name) noexcept
    : calibration_(calibration), name_(std::move(name)), monitor_(calibration) {
  publish_state();
}

SensorSpec DeviceEndpoint::sensor() const noexcept {
  return {.encoder_step_m = std::max(calibration_.encoder_step_m, 1.0 / calibration_.counts_per_metre)};
}

void DeviceEndpoint::connected(double now_s) noexcept {
  last_written_s_.store(now_s, std::memory_order_relaxed);
  connected_at_s_.store(now_s, std::memory_order_relaxed);
  connected_ = true;
  publish_state();
}

void DeviceEndpoint::unplugged() noexcept {
  monitor_.unplugged();
  connected_ = false;
  publish_state();
}

void DeviceEndpoint::publish_state() noexcept {
  MonitorState state = monitor_.state();
  state.health.round_trip_s = round_trip_s_;
  if (!connected_) state.health.faults = device_fault::kUnplugged;
  state_.write(state);
}

void DeviceEndpoint::report_arrived(const std::uint8_t* bytes, std::size_t size, double now_s) noexcept {
  if (zeroing_asked_.exchange(false, std::memory_order_relaxed)) monitor_.start_zeroing();
  const MonitorState before = monitor_.state();
  DeviceReading reading;
  const ReportVerdict verdict = calibration_.protocol->decode(bytes, size, reading);
  monitor_.update(verdict, reading, now_s, commanded_N_.load(std::memory_order_relaxed));
  const MonitorState& state = monitor_.state();
  if (state.samples != before.samples) publish_sample();
  if (state.confirmed != before.confirmed) {
    const double sent_s = sent_at_s_[state.confirmed % sent_at_s_.size()].load(std::memory_order_relaxed);
    if (sent_s > 0.0) round_trip_s_ = now_s - sent_s;
  }
  publish_state();
}

void DeviceEndpoint::publish_sample() noexcept {
  const MonitorState& state = monitor_.state();
  accepted_.store(state.samples, std::memory_order_relaxed);
  if (state.lost != 0 || !state.health.may_push()) return;
  DeviceSample sample;
  sample.tool.time_s = state.sample_time_s;
  const double counts = static_cast<double>(state.counts) - state.zero_counts;
  sample.tool.position_m =
      calibration_.rest_position_m + calibration_.direction * counts / calibration_.counts_per_metre;
  sample.measured_N = state.measured_N;
  sample.restart = state.streams != streams_published_;
  if (samples_.push(sample)) streams_published_ = state.streams;
}

OutReports DeviceEndpoint::next(double now_s) noexcept {
  const Command command = command_.newest();
  const bool fresh = command.heartbeat != last_heartbeat_;
  if (fresh) {
    last_heartbeat_ = command.heartbeat;
    last_beat_s_ = now_s;
  }
  const std::uint64_t samples = accepted_.load(std::memory_order_relaxed);
  const bool due = calibration_.protocol->timed ? samples != answered_ : fresh;
  const double repeat_s = calibration_.protocol->timed ? kSlowestSample_s : kRepeat_s;
  // A change to no force is sent at once.
  const bool lets_go = fresh && command.force_N == 0.0 && commanded_N_.load(std::memory_order_relaxed) != 0.0;
  if (!(due && fresh) && !lets_go && last_sent_s_ >= 0.0 && now_s - last_sent_s_ < repeat_s) return {};
  last_sent_s_ = now_s;
  answered_ = samples;
  const bool haptics_live = now_s - last_beat_s_ < kHapticsSilent_s;
  const double peak_N = calibration_.limits.largest_N;
  const bool drives = haptics_live && std::isfinite(command.force_N);
  const double safe_N = drives ? std::clamp(command.force_N, -peak_N, peak_N) : 0.0;
  commanded_N_.store(safe_N, std::memory_order_relaxed);
  sent_at_s_[++sequence_ % sent_at_s_.size()].store(now_s, std::memory_order_relaxed);
  return calibration_.protocol->encode_command(
      {.sequence = sequence_,
       .heartbeat = last_heartbeat_,
       .drive = safe_N != 0.0,
       .units = -calibration_.direction * safe_N / calibration_.force_N_per_unit});
}

// After a pause of the haptics thread, skips old samples; `restart` is set if any of them began a new stream.
bool DeviceEndpoint::read(double, DeviceSample& sample) noexcept {
  bool restart = false;
  DeviceSample next;
  do {
    if (!samples_.pop(next)) return false;
    restart = restart || next.restart;
  } while (samples_.size() >= static_cast<std::size_t>(kMaxSamplesPerTick));
  sample = next;
  sample.restart = restart;
  began_ = true;
  return true;
}

void DeviceEndpoint::write(double force_N) noexcept {
  // Before the first sample, the force is 0 in any case. Later, the limiter ramps it down where necessary.
  next_command_.force_N = began_ ? force_N : 0.0;
  ++next_command_.heartbeat;
  command_.write(next_command_);
}

// `health` reports late samples; the limiter's own limit is the longest possible one.
ForceLimits DeviceEndpoint::limits() const noexcept {
  ForceLimits limits = calibration_.limits;
  if (calibration_.protocol->timed) limits.stale_after_s = StreamMonitor::kLongestSilence_s;
  return limits;
}

bool DeviceEndpoint::stalled(const MonitorState& state, double now_s) const noexcept {
  if (now_s - last_written_s_.load(std::memory_order_relaxed) > kWriteStalled_s) return true;
  if (!calibration_.protocol->confirms) return false;
  if (state.health.round_trip_s > kWriteStalled_s) return true;
  const double confirmed_s = std::max(state.confirmed_at_s, connected_at_s_.load(std::memory_order_relaxed));
  return now_s - confirmed_s > kWriteStalled_s;
}

DeviceHealth DeviceEndpoint::health(double now_s) noexcept {
  const MonitorState& state = state_.newest();
  DeviceHealth health = state.health;
  if (state.samples > 0) health.sample_age_s = std::max(0.0, now_s - state.sample_time_s);
  if (health.faults == 0) {
    if (health.sample_age_s > state.late_after_s)
      health.faults |= device_fault::kLate | (state.corrupt > 0 ? device_fault::kCorrupt : 0U);
    if (stalled(state, now_s)) health.faults |= device_fault::kWriteStalled;
  }
  health.faults |= state.lost;
  if (now_s < state.transient_until_s) health.faults |= state.transient;
  // A round trip includes the wait for the next sample, at least half the time for which a force is constant. A
  // repeated command shortens the wait of its confirmation, but not the time for which the force is constant. A device
  // without confirmations is on USB, which takes a frame of 1 ms in each direction.
  const double round_trip_s = std::max(health.round_trip_s > 0.0 ? health.round_trip_s : 2e-3, health.interval_s);
  health.lag_s = kWaits_s + round_trip_s + 0.5 * std::max(0.0, 1e-3 - health.interval_s);
  return health;
}

}  // namespace palpate
