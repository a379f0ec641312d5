#include "devices/hid/report_monitor.h"

#include <algorithm>
#include <cmath>

#include "devices/firmware/paddle/paddle_protocol.h"

namespace palpate {
namespace {

// Beyond the fastest motion: a few counts of noise.
constexpr double kNoiseCounts = 4.0;
// Time steps between samples are at least this, else a report on the heels of
// another would look fast.
constexpr double kShortestStep_s = 1e-3;
// Two samples must not have the same time.
constexpr double kLeastStep_s = 1e-6;

}  // namespace

ReportMonitor::ReportMonitor(const MonitorSettings& settings) noexcept : settings_(settings) {
  if (!pushes(settings_.kind)) state_.zeroing = Zeroing::not_needed;
}

void ReportMonitor::fault(std::uint32_t bit, double now_s) noexcept {
  if (now_s >= state_.transient_until_s) state_.transient = 0;
  state_.transient |= bit;
  state_.transient_until_s = now_s + kHold_s;
}

void ReportMonitor::lose(std::uint32_t bit) noexcept {
  if (!pushes(settings_.kind)) return;  // its position is where it is pushed to
  state_.lost |= bit;
  state_.zeroing = Zeroing::needed;
  state_.zeroing_progress = 0.0F;
}

void ReportMonitor::unplugged() noexcept {
  connected_ = false;
  state_.lost |= device_fault::kUnplugged;
  lose(device_fault::kUnplugged);
}

void ReportMonitor::start_zeroing() noexcept {
  if (state_.zeroing == Zeroing::not_needed) return;
  state_.zeroing = Zeroing::hold_still;
  state_.zeroing_progress = 0.0F;
  zeroing_since_s_ = -1.0;
}

bool ReportMonitor::in_order(const HidReading& reading, double now_s) noexcept {
  if (!has_sequence(settings_.kind) || !connected_) return true;
  if (reading.boot != last_.boot) {
    lose(device_fault::kReset);
    connected_ = false;
    return true;
  }
  if (paddle::later(reading.sequence, last_.sequence)) return true;
  // The same report again says nothing new; its age will tell.
  if (reading.sequence != last_.sequence) fault(device_fault::kOutOfOrder, now_s);
  return false;
}

bool ReportMonitor::recent(const HidReading& reading, double now_s) noexcept {
  const bool together = now_s - arrivals_s_[2] < kTogether_s;
  std::copy_backward(arrivals_s_, arrivals_s_ + 2, arrivals_s_ + 3);
  arrivals_s_[0] = now_s;
  if (!has_sequence(settings_.kind)) {
    read_time_s_ = now_s;
    if (together && pushes(settings_.kind)) fault(device_fault::kBurst, now_s);
    return !(together && pushes(settings_.kind));
  }
  if (!connected_) clock_.restart();
  read_time_s_ = clock_.host_time_s(reading.time_us, now_s);
  if (now_s - read_time_s_ <= settings_.stale_after_s) return true;
  fault(now_s - arrivals_s_[1] < kTogether_s ? device_fault::kBurst : device_fault::kLate, now_s);
  return false;
}

// Unwraps the counter and judges the step.
void ReportMonitor::move(const HidReading& reading) noexcept {
  if (!connected_) {
    state_.counts = reading.counts;
    return;
  }
  std::int64_t step = static_cast<std::int32_t>(static_cast<std::uint32_t>(reading.counts) -
                                                static_cast<std::uint32_t>(last_.counts));
  if (count_bits(settings_.kind) == 16) step = static_cast<std::int16_t>(step & 0xFFFF);
  const double step_s = std::max(kShortestStep_s, read_time_s_ - state_.sample_time_s);
  const double most = settings_.counts_per_metre * settings_.fastest_m_per_s * step_s + kNoiseCounts;
  if (pushes(settings_.kind) && std::abs(static_cast<double>(step)) > most) lose(device_fault::kJump);
  state_.counts += step;
}

void ReportMonitor::watch_stuck(double now_s, double force_N) noexcept {
  if (!(std::abs(force_N) >= kPushing_N)) still_since_s_ = now_s;
  if (now_s - still_since_s_ > settings_.stuck_after_s) lose(device_fault::kStuck);
}

void ReportMonitor::watch_zeroing(double now_s) noexcept {
  if (state_.zeroing != Zeroing::hold_still) return;
  zeroing_from_ = std::min(zeroing_from_, state_.counts);
  zeroing_to_ = std::max(zeroing_to_, state_.counts);
  const double most = std::max(2.0, kRest_m * settings_.counts_per_metre);
  if (zeroing_since_s_ < 0.0 || static_cast<double>(zeroing_to_ - zeroing_from_) > most) {
    zeroing_since_s_ = now_s;
    zeroing_from_ = zeroing_to_ = state_.counts;
  }
  const double share = (now_s - zeroing_since_s_) / kZeroing_s;
  state_.zeroing_progress = static_cast<float>(std::min(1.0, share));
  if (share < 1.0) return;
  state_.zero_counts = 0.5 * static_cast<double>(zeroing_from_ + zeroing_to_);
  state_.zeroing = Zeroing::done;
  state_.lost = 0;
  ++state_.zeroings;
}

void ReportMonitor::take(const std::uint8_t* bytes, std::size_t size, double now_s, double force_N) noexcept {
  HidReading reading;
  const ReportVerdict verdict = decode_report(settings_.kind, bytes, size, reading);
  if (verdict == ReportVerdict::corrupt) fault(device_fault::kCorrupt, now_s);
  if (verdict == ReportVerdict::wrong_version) fault(device_fault::kWrongFirmware, now_s);
  if (reading.own_fault) fault(device_fault::kOwn, now_s);
  if (verdict != ReportVerdict::position) return;
  if (!in_order(reading, now_s) || !recent(reading, now_s)) return;
  const std::int64_t before = state_.counts;
  move(reading);
  if (!connected_ || state_.counts != before) still_since_s_ = now_s;
  if (!connected_ || reading.confirmed != last_.confirmed) {
    state_.confirmed = reading.confirmed;
    state_.confirmed_at_s = now_s;
  }
  state_.sample_time_s = std::max(read_time_s_, state_.sample_time_s + kLeastStep_s);
  state_.grip = reading.grip;
  ++state_.samples;
  last_ = reading;
  connected_ = true;
  if (!pushes(settings_.kind)) state_.lost = 0;  // plugged in again is enough
  watch_stuck(now_s, force_N);
  watch_zeroing(now_s);
}

}  // namespace palpate
