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
  if (!connected_) state.health.faults = device_fault::kUnplugged;
  state_.write(state);
}

void DeviceEndpoint::report_arrived(const std::uint8_t* bytes, std::size_t size, double now_s) noexcept {
  if (zeroing_asked_.exchange(false, std::memory_order_relaxed)) monitor_.start_zeroing();
  const MonitorState before = monitor_.state();
  DeviceReading reading;
  const ReportVerdict verdict = calibration_.protocol->decode(bytes, size, reading);
  monitor_.update(verdict, reading, now_s, commanded_N_.load(std::memory_order_relaxed));
  if (monitor_.state().samples != before.samples) publish_sample(reading, now_s);
  publish_state();
}

// By the confirmed command, in the device's own clock: exact, however samples and commands were delayed, held or
// grouped. A new command may have replaced the one before just before this sample. Without confirmations, the force of
// a sample acts at most until the command that follows the next one. Commands of an earlier stream do not count.
ForceAge DeviceEndpoint::force_age(const DeviceReading& reading, double now_s) noexcept {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  if (!calibration_.protocol->confirms) {
    const double gap_s = now_s - std::exchange(arrived_s_, now_s);
    if (!(gap_s < StreamMonitor::kLongestSilence_s)) return {kUnknown, kUnknown};
    return {kUsb_s, gap_s + kUsb_s + kWaits_s};
  }
  if (std::exchange(aged_stream_, monitor_.state().streams) != monitor_.state().streams) began_us_ = reading.time_us;
  const std::uint64_t sent = sent_[reading.confirmed % sent_.size()].load(std::memory_order_relaxed);
  const auto from_us = static_cast<std::uint32_t>(sent);
  const bool known = (sent >> 32) == ((kFromSample >> 32) | (reading.confirmed & 0xFFFF)) &&
                     static_cast<std::int32_t>(from_us - began_us_) >= 0;
  const std::uint32_t before_us = std::exchange(acted_from_us_, from_us);
  if (!std::exchange(acted_known_, known) || !known) return {kUnknown, kUnknown};
  const auto since_s = [&](std::uint32_t us) { return 1e-6 * static_cast<std::int32_t>(reading.time_us - us); };
  return {since_s(from_us), since_s(before_us)};
}

void DeviceEndpoint::publish_sample(const DeviceReading& reading, double now_s) noexcept {
  const MonitorState& state = monitor_.state();
  const ForceAge age = force_age(reading, now_s);
  if (age.least_s > kWriteStalled_s) monitor_.fault(device_fault::kWriteStalled, now_s);
  if (state.lost != 0 || !state.health.may_push()) return;
  DeviceSample sample;
  sample.force_age = age;
  sample.tool.time_s = state.sample_time_s;
  const double counts = static_cast<double>(state.counts) - state.zero_counts;
  sample.tool.position_m =
      calibration_.rest_position_m + calibration_.direction * counts / calibration_.counts_per_metre;
  sample.measured_N = state.measured_N;
  sample.restart = state.streams != streams_published_;
  if (samples_.push({sample, state.samples, reading.time_us})) streams_published_ = state.streams;
}

OutReports DeviceEndpoint::next(double now_s) noexcept {
  const Command command = command_.newest();
  const bool fresh = command.heartbeat != last_heartbeat_;
  if (fresh) {
    last_heartbeat_ = command.heartbeat;
    last_beat_s_ = now_s;
  }
  const bool due = !calibration_.protocol->timed || command.sample != answered_;
  const double repeat_s = calibration_.protocol->timed ? kSlowestSample_s : kRepeat_s;
  // A change to no force is sent at once.
  const bool lets_go = fresh && command.force_N == 0.0 && commanded_N_.load(std::memory_order_relaxed) != 0.0;
  if (!(due && fresh) && !lets_go && last_sent_s_ >= 0.0 && now_s - last_sent_s_ < repeat_s) return {};
  last_sent_s_ = now_s;
  answered_ = command.sample;
  const bool haptics_live = now_s - last_beat_s_ < kHapticsSilent_s;
  const double peak_N = calibration_.limits.largest_N;
  const bool drives = haptics_live && std::isfinite(command.force_N);
  const double safe_N = drives ? std::clamp(command.force_N, -peak_N, peak_N) : 0.0;
  commanded_N_.store(safe_N, std::memory_order_relaxed);
  ++sequence_;
  const std::uint64_t from = (command.sample > 0 ? kFromSample : 0U) | std::uint64_t{sequence_ & 0xFFFF} << 32;
  sent_[sequence_ % sent_.size()].store(from | command.from_us, std::memory_order_relaxed);
  return calibration_.protocol->encode_command(
      {.sequence = sequence_,
       .heartbeat = last_heartbeat_,
       .drive = safe_N != 0.0,
       .units = -calibration_.direction * safe_N / calibration_.force_N_per_unit});
}

// After a pause of the haptics thread, skips old samples; `restart` is set if any of them began a new stream.
bool DeviceEndpoint::read(double, DeviceSample& sample) noexcept {
  bool restart = false;
  TimedSample next;
  do {
    if (!samples_.pop(next)) return false;
    restart = restart || next.sample.restart;
  } while (samples_.size() >= static_cast<std::size_t>(kMaxSamplesPerTick));
  sample = next.sample;
  sample.restart = restart;
  next_command_.sample = next.number;
  next_command_.from_us = next.time_us;
  return true;
}

void DeviceEndpoint::write(double force_N) noexcept {
  // Before the first sample, the force is 0 in any case. Later, the limiter ramps it down where necessary.
  next_command_.force_N = next_command_.sample > 0 ? force_N : 0.0;
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
  return health;
}

}  // namespace palpate
