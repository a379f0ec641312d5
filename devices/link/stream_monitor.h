// Follows the stream of readings of one device, whatever the transport: where the
// tool is, since when it is known, and what is wrong with the stream. Pure: no
// clock, no thread, no decoding.
//
//   a report that fails its decoder                       kCorrupt
//   a sequence number that goes back                      kOutOfOrder
//   reports that waited in a queue (device time, or four
//   within kTogether_s)                                   kBurst
//   a step faster than the device, or a hand, can move    kJump
//   sequence numbers that begin anew                      kReset
//   no count in `stuck_after_s` in spite of kPushing_N    kStuck
//   a device that stopped by its watchdog                 kWriteStalled
// Reports that do not come at all are found by their age, by
// whoever reads the device. A
// fault that leaves the position known lasts kHold_s after its last occurrence;
// one that loses it, until the device was zeroed; a device that knows its position by
// itself does not lose it. A faulty report is never used.
//
// Thread guarantee: one thread; wait-free, never throws.
#pragma once

#include <cstdint>

#include "devices/link/device_clock.h"
#include "devices/link/device_reading.h"
#include "engine/live/device_health.h"

namespace palpate {

struct MonitorSettings {
  bool absolute = false, timed = false;  // as DeviceProtocol
  double counts_per_metre = 1.0;
  double fastest_m_per_s = 5.0;
  double encoder_step_m = 0.0;  // a step of the sensor, where it is more than a count
  double stale_after_s = 0.01;  // the least of late_after_s
  double stuck_after_s = 0.5;
};

// What is known after a report; handed to the haptics thread as a whole.
struct MonitorState {
  std::uint64_t samples = 0;   // accepted so far; 0: none
  std::int64_t counts = 0;     // unwrapped, of the newest accepted
  double sample_time_s = 0.0;  // host clock, strictly increasing
  double zero_counts = 0.0;
  double transient_until_s = 0.0;
  double confirmed_at_s = 0.0;  // when `confirmed` last went on
  std::uint32_t confirmed = 0;
  std::uint32_t transient = 0;  // device_fault, until transient_until_s
  std::uint32_t lost = 0;       // device_fault, until zeroed
  std::uint32_t streams = 0;    // begun so far: at a zeroing, or where the position is found again
  double interval_s = 0.0;      // between samples, of the last ten or so
  double late_after_s = 0.0;    // age of a sample that is too old, see StreamMonitor
  double measured_N = std::numeric_limits<double>::quiet_NaN();
  Zeroing zeroing = Zeroing::needed;
  float zeroing_progress = 0.0F;
  bool grip = false;
};

class StreamMonitor {
 public:
  static constexpr double kHold_s = 0.1;
  static constexpr double kTogether_s = 0.5e-3;
  static constexpr double kPushing_N = 0.2;
  // From one sample to the next the speed grows by less: 50 N, a hand and a motor together, on 50 g. So 5 mm within
  // 1 ms are a glitch, however fast the device may be in the long run.
  static constexpr double kQuickest_m_per_s2 = 1000.0;
  // The tool has to rest for as long, within kRest_m, to be zeroed.
  static constexpr double kZeroing_s = 0.2;
  static constexpr double kRest_m = 0.5e-3;
  // As many readings in order among themselves that were expected earlier: the device
  // counts anew.
  static constexpr int kStartedAgain = 8;
  // A sample is late when it is older than five intervals, 10 ms at least (the calibration's stale_after_s) and
  // 100 ms at most; a stream that was late is on time again when its samples are half as old.
  static constexpr double kLateIntervals = 5.0;
  static constexpr double kLongestSilence_s = 0.1;
  static constexpr double kOnTimeAgain = 0.5;
  // A timed stream begins anew after kLongestSilence_s without a usable reading and where its clock was set back. The
  // readings of its first kSettling_s only set the clock, for they may have waited in a queue.
  static constexpr double kSettling_s = 0.05;

  explicit StreamMonitor(const MonitorSettings& settings) noexcept;

  // A report that came at `now_s`, never earlier than the one before, as its decoder
  // read it; `force_N`: what the device was told to push with.
  void update(ReportVerdict verdict, const DeviceReading& reading, double now_s, double force_N) noexcept;
  // The device is gone; what comes next comes from another start of it.
  void unplugged() noexcept;
  void start_zeroing() noexcept;

  const MonitorState& state() const noexcept { return state_; }

 private:
  void fault(std::uint32_t bit, double now_s) noexcept;
  void lose(std::uint32_t bit, double now_s) noexcept;
  bool started_again(const DeviceReading& reading) noexcept;
  bool in_order(const DeviceReading& reading, double now_s) noexcept;
  void watch_clock(const DeviceReading& reading, double now_s) noexcept;
  bool settled(const DeviceReading& reading, double now_s) noexcept;
  bool recent(const DeviceReading& reading, double now_s) noexcept;
  void move(const DeviceReading& reading, double now_s) noexcept;
  void watch_stuck(double now_s, double force_N) noexcept;
  void watch_zeroing(double now_s) noexcept;

  MonitorSettings settings_;
  MonitorState state_;
  DeviceClock clock_;
  DeviceReading last_;
  std::uint32_t refused_ = 0;  // sequence of the last reading that was out of order
  int refused_in_order_ = 0;
  bool connected_ = false;                     // a report was accepted since the start or since unplugging
  double first_s_ = -1.0;                      // of a device that knows its position: the first reading since
  double read_time_s_ = 0.0;                   // of the present reading
  double speed_ = 0.0;                         // counts a second, of the last step
  double arrivals_s_[3] = {-1e9, -1e9, -1e9};  // of the last three reports, newest first
  double still_since_s_ = 0.0;
  bool late_ = false;
  double zeroing_since_s_ = -1.0;  // below 0: not begun
  std::int64_t zeroing_from_ = 0, zeroing_to_ = 0;
};

}  // namespace palpate
