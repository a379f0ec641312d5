// Samples of given motions and forces, without the errors of sensors and motion estimates.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "models/samples/samples.h"

namespace palpate::test {

// One row of such samples.
struct ExactRow {
  double time_s = 0.0;
  double position_m = 0.0;
  double velocity_m_per_s = 0.0;
  double force_N = 0.0;
  int fold = 0;
};

// `row_at`: gives the rows 0 to `rows` - 1 of one recording. The ranges are those of the rows, except `depth_m`.
template <typename RowAt>
Samples exact_samples(std::size_t rows, double depth_m, const RowAt& row_at) {
  Samples samples;
  samples.offsets.resize(1);
  samples.depth_m = depth_m;
  double squares = 0.0;
  int strokes = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    const ExactRow row = row_at(i);
    const bool contact = row.position_m > 0.0;
    if (contact && (i == 0 || !(samples.rows.back().tool.position_m > 0.0))) ++strokes;
    samples.rows.push_back(
        {{row.time_s, row.position_m, 0.0, 0.0}, {row.position_m, row.velocity_m_per_s}, row.force_N});
    samples.recording.push_back(0);
    samples.stroke.push_back(strokes);
    samples.fold.push_back(row.fold);
    samples.folds = std::max(samples.folds, row.fold + 1);
    if (!contact) continue;
    samples.contact.push_back(i);
    samples.force_N = std::max(samples.force_N, row.force_N);
    squares += row.velocity_m_per_s * row.velocity_m_per_s;
  }
  samples.recorded_rows = rows;
  samples.longest_recording_s = samples.rows.back().tool.time_s - samples.rows.front().tool.time_s;
  samples.sample_s = samples.longest_recording_s / static_cast<double>(std::max<std::size_t>(1, rows - 1));
  samples.rms_velocity_m_per_s =
      std::max(1e-6, std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, samples.contact.size()))));
  return samples;
}

}  // namespace palpate::test
