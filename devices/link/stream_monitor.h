// Monitors the readings of one device, for all transports: position, zeroing and faults. It has no clock and no thread,
// and does not decode. A fault on the right has the cause on the left:
//
//   the decoder refuses a report of another version                       kWrongFirmware
//   a sequence number decreases                                           kOutOfOrder
//   timed: a sample is older than late_after_s                            kLate
//   untimed: four reports within kTogether_s waited in a queue            kBurst
//   a step is faster than the device or a hand can move                   kJump
//   sequence numbers or the device's time start again                     kReset
//   no count changes within `stuck_after_s` at kPushing_N or more,
//     although the force is kFirm_N or changes by kPushing_N              kStuck
//   the device's watchdog has stopped it                                  kWriteStalled
//   the device reports a fault                                            kOwn
//   fewer than 100 samples a second                                       kSlow
// Missing reports are detected by DeviceEndpoint::health; a corrupt report is a missing one. A fault that does not
// affect the position lasts kHold_s after its last occurrence, one that comes often kOften_s. A fault that loses the
// position of an incremental encoder (kJump, kReset, kStuck) lasts until the device is zeroed. A reading that is out of
// order or late is not used. Thread guarantee: one thread; wait-free, never throws.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "devices/link/device_protocol.h"
#include "engine/live/device.h"

namespace palpate {

// Converts the device's time of a sample to the host's clock. The device's clock is assumed linear in the host's clock,
// and every report arrives with a delay of the transport:
//
//   arrival - device time = a + b (device time) + delay,  delay >= 0
//
// The line is the highest one below all points of the last half second (the linear programme of Moon, Skelly & Towsley,
// "Estimation and removal of clock skew from network delay measurements", INFOCOM 1999), of which only the lowest one
// in each 50 ms is used. This removes jitter and follows drift at every rate of reports. A delay that stays longer for
// more than half a second becomes part of the line.
class DeviceClock {
 public:
  // `device_us` wraps at 32 bits; `arrival_s` is non-decreasing. Returns host seconds, at most `arrival_s`.
  double host_time_s(std::uint32_t device_us, double arrival_s) noexcept {
    if (started_) device_s_ += 1e-6 * static_cast<double>(static_cast<std::int32_t>(device_us - last_us_));
    last_us_ = device_us;
    const Point point{device_s_, arrival_s - device_s_};
    if (!started_) {
      started_ = true;
      middle_s_ = device_s_;
      level_s_ = point.lag_s;
      lowest_ = point;
    }
    if (point.device_s - segment_from_s_ >= kSegment_s) {
      points_[count_++ % kSegments] = lowest_;
      fit();
      segment_from_s_ = point.device_s;
      lowest_ = point;
    }
    if (above_line_s(point) < above_line_s(lowest_)) lowest_ = point;
    level_s_ += std::min(0.0, above_line_s(point));
    return std::min(arrival_s, arrival_s - above_line_s(point));
  }

 private:
  // Well above the error of a ceramic resonator, 0.5 %, plus that of a host clock which is slewed, 0.5 %.
  static constexpr double kLargestDrift = 0.015, kSegment_s = 0.05;
  static constexpr std::size_t kSegments = 10;

  struct Point {
    double device_s = 0.0, lag_s = 0.0;
  };

  double above_line_s(const Point& point) const noexcept {
    return point.lag_s - level_s_ - drift_ * (point.device_s - middle_s_);
  }

  // Among the slopes between two points, chooses the one whose line is highest at the mean time.
  void fit() noexcept {
    const std::size_t count = std::min(count_, kSegments);
    middle_s_ = 0.0;
    for (std::size_t i = 0; i < count; ++i) middle_s_ += points_[i].device_s / static_cast<double>(count);
    level_s_ = -std::numeric_limits<double>::infinity();
    try_slope(0.0, count);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double slope = (points_[i].lag_s - points_[j].lag_s) / (points_[i].device_s - points_[j].device_s);
        try_slope(std::clamp(slope, -kLargestDrift, kLargestDrift), count);
      }
    }
  }
  void try_slope(double slope, std::size_t count) noexcept {
    double level_s = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count; ++i)
      level_s = std::min(level_s, points_[i].lag_s - slope * (points_[i].device_s - middle_s_));
    if (!(level_s > level_s_)) return;
    level_s_ = level_s;
    drift_ = slope;
  }

  std::array<Point, kSegments> points_{};
  std::size_t count_ = 0;
  Point lowest_;  // of the present segment
  double segment_from_s_ = 0.0;
  double middle_s_ = 0.0, level_s_ = 0.0, drift_ = 0.0;  // the line
  double device_s_ = 0.0;
  std::uint32_t last_us_ = 0;
  bool started_ = false;
};

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
  static constexpr double kHold_s = 0.1, kTogether_s = 0.5e-3, kPushing_N = 0.2, kFirm_N = 1.0;
  // A fault that comes again within this time lasts as long, so that a line at its limit does not switch the force on
  // and off.
  static constexpr double kOften_s = 2.0;
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
  // Another fault of the device.
  void fault(std::uint32_t bit, double now_s) noexcept;
  // The device was unplugged; the next report begins a new stream.
  void unplugged() noexcept;
  void start_zeroing() noexcept;

  const MonitorState& state() const noexcept { return state_; }

 private:
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
  double still_since_s_ = 0.0;                 // the last change of a count
  double least_N_ = 0.0, most_N_ = 0.0;        // of the force since then
  bool stuck_ = false;
  bool late_ = false;
  double hold_s_ = kHold_s;        // of the present fault
  double zeroing_since_s_ = -1.0;  // below 0: not begun
  std::int64_t zeroing_from_ = 0, zeroing_to_ = 0;
};

}  // namespace palpate
