// Monitors the readings of one device, for all transports: position, zeroing and faults. It has no clock and no thread,
// and does not decode. A fault on the right has the cause on the left:
//
//   the decoder refuses a report of another version                       kWrongFirmware
//   a sequence number decreases                                           kOutOfOrder
//   timed: a sample is older than late_after_s                            kLate
//   untimed: four reports within kTogether_s waited in a queue            kBurst
//   a step is faster than the device or a hand can move                   kJump
//   sequence numbers or the device's time start again                     kReset
//   no count changes within `stuck_after_s` at kPushing_N or more         kStuck
//   the device's watchdog has stopped it                                  kWriteStalled
//   the device reports a fault                                            kOwn
//   fewer than 100 samples a second                                       kSlow
// Missing reports are detected by DeviceEndpoint::health; a corrupt report is a missing one. A fault that does not
// affect the position lasts kHold_s after its last occurrence. A fault that loses the position of an incremental
// encoder (kJump, kReset, kStuck) lasts until the device is zeroed. A reading that is out of order or late is not used.
// Thread guarantee: one thread; wait-free, never throws.
#pragma once

#include <cstdint>

#include "devices/link/device_calibration.h"
#include "devices/link/device_clock.h"
#include "engine/live/device.h"
#include "engine/live/sample_rate.h"

namespace palpate {

// The state after a report. The haptics thread gets a copy of it.
struct MonitorState {
  std::uint64_t samples = 0;   // number of accepted samples
  std::uint64_t corrupt = 0;   // number of corrupt reports since the last of them
  std::int64_t counts = 0;     // of the newest accepted sample, unwrapped
  double sample_time_s = 0.0;  // host clock, strictly increasing
  double zero_counts = 0.0;    // counts at the rest position
  double transient_until_s = 0.0;
  double confirmed_at_s = 0.0;  // time of the last change of `confirmed`
  std::uint32_t confirmed = 0;  // sequence of the last confirmed command
  std::uint32_t transient = 0;  // bits of device_fault that end at transient_until_s
  std::uint32_t lost = 0;       // bits of device_fault that end when the device is zeroed
  std::uint32_t streams = 0;    // number of streams; one begins when the position becomes known or jumps
  double late_after_s = 0.0;    // largest permitted age of a sample, see kLateIntervals
  double measured_N = std::numeric_limits<double>::quiet_NaN();
  DeviceHealth health;  // zeroing, grip and interval
};

class StreamMonitor {
 public:
  static constexpr double kHold_s = 0.1, kTogether_s = 0.5e-3, kPushing_N = 0.2;
  // Largest acceleration: 50 N of hand and motor together on 50 g. A motion of 5 mm within 1 ms from rest is therefore
  // a fault even where fastest_m_per_s allows it.
  static constexpr double kQuickest_m_per_s2 = 1000.0;
  // For zeroing the tool has to rest within kRest_m for this time.
  static constexpr double kZeroing_s = 0.2;
  static constexpr double kRest_m = 0.5e-3;
  // The device has restarted when so many successive readings are in order but older than the last accepted one.
  static constexpr int kStartedAgain = 8;
  // A sample of a timed stream is late when it is older than kLateIntervals intervals, clamped to stale_after_s ..
  // kLongestSilence_s. After a late sample the limit is half of that.
  static constexpr double kLateIntervals = 5.0, kLongestSilence_s = 0.1, kOnTimeAgain = 0.5;
  // A new timed stream begins after kLongestSilence_s without a usable reading, or when the device's clock was set
  // back. The readings of its first kSettling_s only fit the clock, because they may have waited in a queue.
  static constexpr double kSettling_s = 0.05;

  explicit StreamMonitor(const DeviceCalibration& calibration) noexcept;

  // Takes a decoded report that arrived at `now_s` (non-decreasing). `force_N`: the commanded force.
  void update(ReportVerdict verdict, const DeviceReading& reading, double now_s, double force_N) noexcept;
  // The device was unplugged; the next report begins a new stream.
  void unplugged() noexcept;
  void start_zeroing() noexcept;

  const MonitorState& state() const noexcept { return state_; }

 private:
  void fault(std::uint32_t bit, double now_s) noexcept;
  void lose(std::uint32_t bit, double now_s) noexcept;
  // Whether the reading is used. They set read_time_s_; a new stream ends connected_.
  bool accept_untimed(double now_s) noexcept;
  bool accept_timed(const DeviceReading& reading, double now_s) noexcept;
  void move(const DeviceReading& reading, double now_s) noexcept;
  void watch_stuck(double now_s, double force_N) noexcept;
  void watch_zeroing(double now_s) noexcept;

  DeviceCalibration calibration_;
  const DeviceProtocol& protocol_;
  MonitorState state_;
  DeviceClock clock_;
  SampleRate rate_;
  DeviceReading last_;
  std::uint32_t refused_ = 0;  // sequence of the last reading that was out of order
  int refused_in_order_ = 0;
  bool connected_ = false;                     // a reading was accepted since the present stream began
  double first_s_ = -1.0;                      // arrival of the first reading of a new timed stream; below 0: none
  double read_time_s_ = 0.0;                   // of the present reading
  double speed_ = 0.0;                         // counts per second, of the last step
  double arrivals_s_[3] = {-1e9, -1e9, -1e9};  // of the last three untimed readings, newest first
  double still_since_s_ = 0.0;
  bool late_ = false;
  double zeroing_since_s_ = -1.0;  // below 0: not begun
  std::int64_t zeroing_from_ = 0, zeroing_to_ = 0;
};

}  // namespace palpate
