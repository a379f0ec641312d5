#include "models/samples/sample.h"

#include <algorithm>
#include <cmath>

#include "engine/tick/sensor_identification.h"

namespace palpate {

std::vector<Sample> thinned_rows(const Recording& recording, std::size_t most) {
  std::vector<Sample> rows;
  MotionEstimator estimator(identify_sensor(recording.rows.data(), recording.rows.size(), recording.columns));
  const std::size_t stride = recording.rows.size() / most + 1;
  rows.reserve(recording.rows.size() / stride + 1);
  for (std::size_t i = 0; i < recording.rows.size(); ++i) {
    const ToolSample sample = tool_sample(recording.rows[i]);
    const MotionEstimate motion = estimator.update(sample);
    if (i % stride == 0) rows.push_back({sample, motion, recording.rows[i].force_N});
  }
  return rows;
}

std::pair<double, double> position_range_m(const std::vector<Sample>& rows) {
  const auto [low, high] = std::minmax_element(rows.begin(), rows.end(), [](const Sample& a, const Sample& b) {
    return a.motion.position_m < b.motion.position_m;
  });
  return {low->motion.position_m, high->motion.position_m};
}

double median_of(std::vector<double> values) {
  const std::size_t middle = values.size() / 2;
  return values.empty() ? 0.0 : nth_smallest(std::move(values), middle);
}

std::vector<std::size_t> blocks_by_path(const std::vector<Sample>& rows) {
  std::vector<double> path_m(rows.size(), 0.0);
  for (std::size_t i = 1; i < rows.size(); ++i)
    path_m[i] = path_m[i - 1] + std::abs(rows[i].motion.position_m - rows[i - 1].motion.position_m);
  std::vector<std::size_t> block(rows.size(), 0);
  for (std::size_t i = 0; i < rows.size() && path_m.back() > 0.0; ++i) {
    block[i] =
        std::min(kBlocks - 1, static_cast<std::size_t>(path_m[i] / path_m.back() * static_cast<double>(kBlocks)));
  }
  return block;
}

}  // namespace palpate
