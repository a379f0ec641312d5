#include "devices/link/device_link.h"

#include <algorithm>
#include <cmath>

namespace palpate {
// Tolerance of a step beyond the fastest motion, in steps of the sensor.
constexpr double kNoiseSteps = 4.0;
// The speed is computed with at least this time step, because two reports may arrive in quick succession.
constexpr double kShortestStep_s = 1e-3;
// The least difference between the times of two samples.
constexpr double kLeastStep_s = 1e-6;

StreamMonitor::StreamMonitor(const DeviceCalibration& calibration) noexcept
    : calibration_(calibration), protocol_(*calibration.protocol) {
  state_.late_after_s = calibration.limits.stale_after_s;
  state_.health.zeroing = protocol_.absolute ? Zeroing::not_needed : Zeroing::needed;
}

void StreamMonitor::fault(std::uint32_t bit, double now_s) noexcept {
  if (now_s >= state_.transient_until_s) {
    state_.transient = 0;
    hold_s_ = now_s < state_.transient_until_s + kOften_s ? kOften_s : kHold_s;
  }
  state_.transient |= bit;
  state_.transient_until_s = now_s + hold_s_;
}

void StreamMonitor::lose(std::uint32_t bit, double now_s) noexcept {
  if (protocol_.absolute) {
    fault(bit, now_s);
    if (bit == device_fault::kJump) ++state_.streams;
    return;
  }
  state_.lost |= bit;
  state_.health.zeroing = Zeroing::needed;
  state_.health.zeroing_progress = 0.0F;
}

void StreamMonitor::unplugged() noexcept {
  connected_ = false;
  // A device with an absolute position keeps it; the link reports the loss of the connection.
  if (!protocol_.absolute) lose(device_fault::kUnplugged, 0.0);
}

void StreamMonitor::start_zeroing() noexcept {
  if (state_.health.zeroing == Zeroing::not_needed) return;
  state_.health.zeroing = Zeroing::hold_still;
  state_.health.zeroing_progress = 0.0F;
  zeroing_since_s_ = -1.0;
}

bool StreamMonitor::accept_untimed(double now_s) noexcept {
  const bool together = now_s - arrivals_s_[2] < kTogether_s;
  std::copy_backward(arrivals_s_, arrivals_s_ + 2, arrivals_s_ + 3);
  arrivals_s_[0] = now_s;
  read_time_s_ = now_s;
  if (together) fault(device_fault::kBurst, now_s);
  return !together;
}

bool StreamMonitor::accept_timed(const DeviceReading& reading, double now_s) noexcept {
  if (connected_ && static_cast<std::int32_t>(reading.sequence - last_.sequence) <= 0) {
    // A repeated report is ignored; the age of the sample grows until it is late.
    if (reading.sequence == last_.sequence) return false;
    refused_in_order_ = reading.sequence == refused_ + 1 ? refused_in_order_ + 1 : 0;
    refused_ = reading.sequence;
    if (refused_in_order_ < kStartedAgain) {
      fault(device_fault::kOutOfOrder, now_s);
      return false;
    }
    lose(device_fault::kReset, now_s);
    connected_ = false;
  }
  // After a pause, or when the device's clock was set back, a new stream begins: neither the fit of the clock nor the
  // motion continues.
  if (connected_) {
    const bool set_back = static_cast<std::int32_t>(reading.time_us - last_.time_us) <= 0;
    if (set_back) fault(device_fault::kReset, now_s);
    connected_ = !set_back && now_s - state_.sample_time_s <= kLongestSilence_s;
  }
  if (!connected_ && first_s_ < 0.0) {
    clock_ = {};
    first_s_ = now_s;
  }
  read_time_s_ = clock_.host_time_s(reading.time_us, now_s);
  if (!connected_ && now_s - first_s_ < kSettling_s) return false;
  late_ = now_s - read_time_s_ > (late_ ? kOnTimeAgain : 1.0) * state_.late_after_s;
  if (late_) fault(device_fault::kLate, now_s);
  return !late_;
}

// Unwraps the counter and checks the step for a jump.
void StreamMonitor::move(const DeviceReading& reading, double now_s) noexcept {
  if (!connected_) {
    state_.counts = reading.counts;
    speed_ = 0.0;
    return;
  }
  const std::int64_t step =
      static_cast<std::int32_t>(static_cast<std::uint32_t>(reading.counts) - static_cast<std::uint32_t>(last_.counts));
  const double step_s = std::max(kShortestStep_s, read_time_s_ - state_.sample_time_s);
  const double quickest = speed_ + calibration_.counts_per_metre * kQuickest_m_per_s2 * step_s;
  const double fastest = std::min(quickest, calibration_.counts_per_metre * calibration_.fastest_m_per_s);
  const double noise = kNoiseSteps * std::max(1.0, calibration_.encoder_step_m * calibration_.counts_per_metre);
  const double distance = std::abs(static_cast<double>(step));
  const bool jumped = distance > fastest * step_s + noise;
  if (jumped) lose(device_fault::kJump, now_s);
  speed_ = jumped ? 0.0 : distance / step_s;
  state_.counts += step;
}

// No hand keeps a tool within a count for seconds against kFirm_N, nor while a smaller force changes; a small constant
// force is no evidence.
void StreamMonitor::watch_stuck(double now_s, double force_N) noexcept {
  const bool pushing = std::abs(force_N) >= kPushing_N;
  if (!pushing || !pushed_ || still_since_s_ == now_s) least_N_ = most_N_ = force_N;
  pushed_ = pushing;
  least_N_ = std::min(least_N_, force_N);
  most_N_ = std::max(most_N_, force_N);
  const bool evident = pushing && (std::abs(force_N) >= kFirm_N || most_N_ - least_N_ >= kPushing_N);
  // For a device without zeroing, only motion ends the fault: a small force does not.
  if (!evident && !(stuck_ && protocol_.absolute)) still_since_s_ = now_s;
  stuck_ = now_s - still_since_s_ > calibration_.stuck_after_s;
  if (stuck_) lose(device_fault::kStuck, now_s);
}

void StreamMonitor::watch_zeroing(double now_s) noexcept {
  if (state_.health.zeroing != Zeroing::hold_still) return;
  zeroing_from_ = std::min(zeroing_from_, state_.counts);
  zeroing_to_ = std::max(zeroing_to_, state_.counts);
  const double most = std::max(2.0, kRest_m * calibration_.counts_per_metre);
  if (zeroing_since_s_ < 0.0 || static_cast<double>(zeroing_to_ - zeroing_from_) > most) {
    zeroing_since_s_ = now_s;
    zeroing_from_ = zeroing_to_ = state_.counts;
  }
  const double share = (now_s - zeroing_since_s_) / kZeroing_s;
  state_.health.zeroing_progress = static_cast<float>(std::min(1.0, share));
  if (share < 1.0) return;
  state_.zero_counts = 0.5 * static_cast<double>(zeroing_from_ + zeroing_to_);
  state_.health.zeroing = Zeroing::done;
  state_.lost = 0;
  ++state_.streams;
}

void StreamMonitor::update(ReportVerdict verdict, const DeviceReading& reading, double now_s, double force_N) noexcept {
  if (verdict == ReportVerdict::corrupt) ++state_.corrupt;
  if (verdict == ReportVerdict::wrong_version) fault(device_fault::kWrongFirmware, now_s);
  if (reading.own_fault) fault(device_fault::kOwn, now_s);
  if (reading.stopped) fault(device_fault::kWriteStalled, now_s);
  if (verdict != ReportVerdict::position) return;
  if (!(protocol_.timed ? accept_timed(reading, now_s) : accept_untimed(now_s))) return;
  const std::int64_t before = state_.counts;
  move(reading, now_s);
  if (!connected_ && protocol_.absolute) ++state_.streams;
  if (!connected_ || state_.counts != before) still_since_s_ = now_s;
  if (!connected_ || reading.confirmed != last_.confirmed) {
    state_.confirmed = reading.confirmed;
    state_.confirmed_at_s = now_s;
  }
  const double before_s = state_.sample_time_s;
  state_.sample_time_s = std::max(read_time_s_, before_s + kLeastStep_s);
  if (connected_) {
    rate_.add(std::min(state_.sample_time_s - before_s, kHold_s));
    state_.health.interval_s = rate_.interval_s();
    if (rate_.too_slow()) fault(device_fault::kSlow, now_s);
  }
  if (protocol_.timed) {
    state_.late_after_s =
        std::clamp(kLateIntervals * state_.health.interval_s, calibration_.limits.stale_after_s, kLongestSilence_s);
  }
  state_.measured_N = reading.measured_N;
  state_.health.grip_held = reading.grip;
  ++state_.samples;
  state_.corrupt = 0;
  last_ = reading;
  connected_ = true;
  first_s_ = -1.0;
  watch_stuck(now_s, force_N);
  watch_zeroing(now_s);
}

}  // namespace palpate
