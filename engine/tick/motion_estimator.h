// Causal estimates of position and velocity of the tool from quantised positions, with a measured acceleration or
// velocity if there is one, by a Kalman filter. models/METHOD.md has the equations, motion_filter.inc the code,
// which exported models share. On simulated hands (HandMotion) behind a 30 um encoder the velocity
// error is 0.54 of that of first-order adaptive windowing at its best settings, and 0.08 of it with an accelerometer
// (tests/engine/tick/motion_estimator_test.cpp).
// Thread guarantee: one thread at a time; `update` is wait-free, allocates nothing and never throws.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engine/recording/recording.h"
#include "engine/tick/jnd.h"
#include "engine/tick/tool_sample.h"

namespace palpate {

// The filter of motion_filter.inc in double precision.
namespace motion_filter {
using real = double;
#define R(x) (x)
#define SQRT std::sqrt
#define EXP std::exp
#include "engine/tick/motion_filter.inc"
#undef EXP
#undef SQRT
#undef R
}  // namespace motion_filter

struct MotionEstimate {
  double position_m = 0.0, velocity_m_per_s = 0.0;
};

class MotionEstimator {
 public:
  explicit MotionEstimator(const SensorSpec& sensor) noexcept : sensor_(sensor) {}

  // Resets the state; the next sample is the first one.
  void reset() noexcept { state_ = {}; }

  // Takes the next sample and returns the estimate. A sample that is not later than the last one is ignored. So are
  // readings beyond the reach of a hand (20 mm and 10 m/s), for at most 0.1 s; then the filter restarts there.
  // The estimated position is within half an encoder step plus three standard deviations of the noise of the reading.
  MotionEstimate update(const ToolSample& sample) noexcept;
  // The last estimate.
  MotionEstimate estimate() const noexcept { return {state_.estimate_m, state_.velocity_m_per_s}; }
  // Its age if the readings since were beyond the reach of a hand; else 0.
  double age_s() const noexcept { return state_.skipped_s; }

 private:
  SensorSpec sensor_;
  motion_filter::MotionState state_{};
  double time_s_ = 0.0;
};

// Identifies the sensor of a recording, which the motion estimator needs: encoder step, and noise of position, velocity
// and acceleration (models/METHOD.md, Sensor). Thread guarantee: slow side (allocates).

// The rows that are used, from the beginning of a recording.
inline constexpr std::size_t kSensorIdentificationRows = 30000;

SensorSpec identify_sensor(const RecordingRow* rows, std::size_t count, RecordingColumns columns);

// The white noise of the force column, N.
double identify_force_noise_N(const RecordingRow* rows, std::size_t count);

ToolSample tool_sample(const RecordingRow& row) noexcept;

// A force at or below this counts as none: three standard deviations of the noise, at least 10 mN.
inline constexpr double kForceFloor_N = 0.01;
inline double no_force_N(double noise_N) noexcept { return std::max(kForceFloor_N, 3.0 * noise_N); }
// A force above this is certain at any position: five standard deviations of the noise, and the JND.
inline double certain_force_N(double noise_N) noexcept { return std::max(JndLine{}.at(0.0), 5.0 * noise_N); }

}  // namespace palpate
