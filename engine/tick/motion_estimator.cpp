#include "engine/tick/motion_estimator.h"

namespace palpate {

MotionEstimate MotionEstimator::update(const ToolSample& sample) noexcept {
  using namespace motion_filter;
  const double step_s = sample.time_s - time_s_;
  if (state_.started != 0 && !(step_s > 0.0)) return estimate();
  time_s_ = sample.time_s;
  const bool repeated = state_.started != 0 && sample.position_m == state_.position_m;
  if (sensor_.has_acceleration)
    measure_acceleration(&state_, sample.acceleration_m_per_s2, sensor_.acceleration_noise_m_per_s2);
  const double h_s = advance_motion(&state_, step_s, sample.position_m);
  if (!(h_s > 0.0)) return estimate();
  if (sensor_.has_velocity) measure_velocity(&state_, sample.velocity_m_per_s, square(sensor_.velocity_noise_m_per_s));
  measure_position(&state_, h_s, repeated, sensor_.encoder_step_m, sensor_.position_noise_m);
  return estimate();
}

}  // namespace palpate
