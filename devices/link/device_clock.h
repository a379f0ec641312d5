// Converts the device's time of a sample to the host's clock. The device's clock is assumed linear in the host's clock,
// and every report arrives with a delay of the transport:
//
//   arrival - device time = a + b (device time) + delay,  delay >= 0
//
// The line is the highest one below all points of the last half second (the linear programme of Moon, Skelly & Towsley,
// "Estimation and removal of clock skew from network delay measurements", INFOCOM 1999), of which only the lowest one
// in each 50 ms is used. This removes jitter and follows drift at every rate of reports. A delay that stays longer for
// more than half a second becomes part of the line.
// Thread guarantee: one thread; wait-free, never throws.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace palpate {

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

}  // namespace palpate
