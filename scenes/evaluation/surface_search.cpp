#include "scenes/evaluation/evaluate.h"

#include <algorithm>
#include <cmath>

#include "engine/tick/features.h"

namespace palpate {
namespace {

constexpr double kCoarseSearch_m = 0.1e-3;
constexpr double kMostCoarseSteps = 200.0;
constexpr double kSearchHuberLimit = 1.0;  // JND

using ForceErrors = std::vector<double>;  // model minus measured, N, by row

ForceErrors errors_of(const ForceModel& model, const std::vector<Sample>& rows, double offset_m) {
  FeatureFilter filter(model.features());
  ForceErrors errors(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ToolSample sample = rows[i].tool;
    MotionEstimate motion = rows[i].motion;
    sample.position_m -= offset_m;
    motion.position_m -= offset_m;
    const FeatureVector& vector = filter.update(sample, motion);
    const double force_N = vector.in_contact ? model.force(vector.values.data()) : 0.0;
    errors[i] = force_N - rows[i].force_N;
  }
  return errors;
}

// `force_offset_N`: the offset of the measured force.
void add_costs(const ForceErrors& errors, double force_offset_N, const std::vector<Sample>& rows,
               const std::vector<std::size_t>& blocks, const JndLine& jnd, BlockCosts& costs) {
  for (std::size_t i = 0; i < rows.size(); ++i)
    costs[blocks[i]] += huber((errors[i] + force_offset_N) / jnd.at(rows[i].force_N), kSearchHuberLimit);
}

}  // namespace

OffsetEstimate locate_surface(const std::vector<Sample>& rows, const std::vector<ModelPointer>& models,
                              const JndLine& jnd) {
  if (rows.empty() || models.empty()) return {};
  const auto [low_m, high_m] = position_range_m(rows);
  // The range reaches from a recording that is all in air to one that begins at the greatest depth of this one.
  const double reach_m = std::max({high_m - low_m, std::abs(low_m), std::abs(high_m)});
  const std::vector<std::size_t> blocks = blocks_by_path(rows);
  const OffsetEstimate shift = estimate_offset(
      [&](double offset_m) {
        BlockCosts costs(kBlocks, 0.0);
        for (const auto& model : models) add_costs(errors_of(*model, rows, offset_m), 0.0, rows, blocks, jnd, costs);
        return costs;
      },
      {-reach_m, reach_m, std::max(kCoarseSearch_m, 2.0 * reach_m / kMostCoarseSteps), kFinest_m, kWidestSurface_m});
  if (!shift.identified || !shift.not_zero) return shift;
  std::vector<ForceErrors> unmoved;
  double most_N = 0.0;
  for (const auto& model : models) {
    unmoved.push_back(errors_of(*model, rows, 0.0));
    for (const double error_N : unmoved.back()) most_N = std::max(most_N, std::abs(error_N));
  }
  return unless_force_offset(
      shift,
      [&](double offset_N) {
        BlockCosts costs(kBlocks, 0.0);
        for (const ForceErrors& errors : unmoved) add_costs(errors, offset_N, rows, blocks, jnd, costs);
        return costs;
      },
      most_N);
}

}  // namespace palpate
