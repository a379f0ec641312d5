// Identifies the sensor of a recording, which the motion estimator needs: encoder step, and noise of position, velocity
// and acceleration (models/METHOD.md, Sensor). Thread guarantee: slow side (allocates).
#pragma once

#include <algorithm>
#include <cstddef>

#include "engine/recording/recording.h"
#include "engine/tick/jnd.h"
#include "engine/tick/tool_sample.h"

namespace palpate {

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
