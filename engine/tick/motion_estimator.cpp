#include "engine/tick/motion_estimator.h"

namespace palpate {
namespace {

// `n`: the number of states, a constant so that the compiler unrolls all loops over them.
template <int n>
void advance(motion_filter::MotionState& state, const SensorSpec& sensor, const ToolSample& sample,
             double step_s) noexcept {
  using motion_filter::measure_motion;
  using motion_filter::square;
  const bool repeated = state.started != 0 && sample.position_m == state.position_m;
  const double h_s = motion_filter::advance_motion(&state, n, step_s, sample.position_m);
  if (!(h_s > 0.0)) return;
  if (n == 4) measure_motion(&state, n, 2, 3, sample.acceleration_m_per_s2, square(sensor.acceleration_noise_m_per_s2));
  if (sensor.has_velocity)
    measure_motion(&state, n, 1, 1, sample.velocity_m_per_s, square(sensor.velocity_noise_m_per_s));
  motion_filter::measure_position(&state, n, h_s, repeated, sensor.encoder_step_m, sensor.position_noise_m);
}

}  // namespace

MotionEstimate MotionEstimator::update(const ToolSample& sample) noexcept {
  const double step_s = sample.time_s - time_s_;
  if (state_.started != 0 && !(step_s > 0.0)) return estimate();
  time_s_ = sample.time_s;
  (sensor_.has_acceleration ? advance<4> : advance<3>)(state_, sensor_, sample, step_s);
  return estimate();
}

}  // namespace palpate
