// What sensor made a recording: encoder step, noise of position, velocity and
// acceleration, read off the samples. The motion estimator needs it.
//
// Encoder step: the smallest position change, if all the others are multiples
// of it and not all the same, to nine digits. Noise: the standard deviation of second differences over
// the quietest fifth of 50-sample windows, divided by sqrt(6), the factor for white
// noise; motion, which is smooth, is nearly absent there. That of the position is
// rounded to the series 1, 2, 5, 10, so that recordings of one rig have one sensor.
// Errors: none; a column without information gives the finest plausible value.
// Thread guarantee: slow side (allocates).
#pragma once

#include <algorithm>
#include <cstddef>

#include "engine/recording/recording_reader.h"
#include "engine/tick/jnd.h"
#include "engine/tick/tool_sample.h"

namespace palpate {

// Rows that identification looks at, from the beginning of a recording.
inline constexpr std::size_t kSensorIdentificationRows = 30000;

SensorSpec identify_sensor(const RecordingRow* rows, std::size_t count, RecordingColumns columns);
// Of the first rows that `reader` still has. Errors: the reader's.
Result<SensorSpec> identify_sensor(RecordingReader& reader);

// The white noise of the force column, N.
double identify_force_noise_N(const RecordingRow* rows, std::size_t count);

ToolSample tool_sample(const RecordingRow& row) noexcept;

// At or below it a force counts as none: three deviations of the noise, at least 10 mN.
inline constexpr double kForceFloor_N = 0.01;
inline double no_force_N(double noise_N) noexcept { return std::max(kForceFloor_N, 3.0 * noise_N); }
// Beyond it one is there for certain, wherever the tool is: five deviations, and felt.
inline double certain_force_N(double noise_N) noexcept { return std::max(JndLine{}.at(0.0), 5.0 * noise_N); }

}  // namespace palpate
