// What a device, or a recording, says about the tool at one moment.
#pragma once

#include <type_traits>

namespace palpate {

// One sample. Position along the inward surface normal, 0 at the undisturbed
// surface, positive inside the block. Velocity and acceleration only count
// when the sensor has them, see SensorSpec.
struct ToolSample {
  double time_s = 0.0;
  double position_m = 0.0;
  double velocity_m_per_s = 0.0;
  double acceleration_m_per_s2 = 0.0;
};

// What is known about the sensor behind the samples. It belongs to the source
// of the samples (a device declares it, `identify_sensor` reads it off a
// recording), not to the model that they are fed to.
struct SensorSpec {
  double encoder_step_m = 0.0;    // 0: not quantised
  double position_noise_m = 0.0;  // standard deviation beside the quantisation
  bool has_velocity = false;
  double velocity_noise_m_per_s = 0.0;
  bool has_acceleration = false;
  double acceleration_noise_m_per_s2 = 0.0;  // white part; a drifting bias is always allowed for
};

static_assert(std::is_trivially_copyable_v<ToolSample>);
static_assert(std::is_trivially_copyable_v<SensorSpec>);

}  // namespace palpate
