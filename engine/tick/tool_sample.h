// The measured state of the tool at one time, and the sensor that measured it.
#pragma once

namespace palpate {

// The period of the haptics loop.
inline constexpr double kHapticTick_s = 1e-3;

// One sample. The position is along the inward surface normal, 0 at the undisturbed surface, positive inside the block.
// Velocity and acceleration are used only if the sensor has them (SensorSpec).
struct ToolSample {
  double time_s = 0.0, position_m = 0.0, velocity_m_per_s = 0.0, acceleration_m_per_s2 = 0.0;
};

// The sensor of the samples. It belongs to their source (a device declares it, `identify_sensor` determines it from a
// recording), not to the model.
struct SensorSpec {
  double encoder_step_m = 0.0;    // 0: not quantised
  double position_noise_m = 0.0;  // standard deviation in addition to the quantisation
  bool has_velocity = false;
  double velocity_noise_m_per_s = 0.0;
  bool has_acceleration = false;
  double acceleration_noise_m_per_s2 = 0.0;  // white noise only; a drifting bias is always estimated
};

// Whether the tool is in contact with a surface at this position: the only definition, for tick, replay and fits.
constexpr bool in_contact(const ToolSample& sample, double surface_m) noexcept { return sample.position_m > surface_m; }

}  // namespace palpate
