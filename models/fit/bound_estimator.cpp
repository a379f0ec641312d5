#include "models/fit/bound_estimator.h"

#include <algorithm>
#include <cmath>

#include "engine/tick/sensor_identification.h"
#include "models/linear/non_negative.h"

namespace palpate {
namespace {

constexpr std::size_t kFewest = 50;
constexpr double kCoverage = 0.975;
constexpr double kLeastPerDistance = 0.25;  // of the largest force
constexpr double kLeastShape_N = 1e-3;      // above 0, so that the factor enlarges it
// One or two strokes do not show how the next one differs. 5 % of the force is the difference between two specimens of
// a cast silicone (Dawood et al. 2026).
constexpr std::size_t kFewStrokes = 3;
constexpr double kLeastPerForce = 0.05;

}  // namespace

FoldErrors BoundEstimator::add(const ResidualRows& rows, const ModelData& common,
                               const std::vector<CorrectionPtr>& corrections) {
  const double inner_radius = common.cover.inner_radius;
  FoldErrors errors(static_cast<std::size_t>(rows.folds()));
  for (std::size_t i = 0; i < rows.fold.size(); ++i) {
    if (!std::isfinite(rows.distance[i])) continue;  // there is no other fold
    const auto row = static_cast<Eigen::Index>(i);
    double correction_N = 0.0;
    if (!corrections.empty()) {
      const Eigen::VectorXd point = rows.points.col(row);
      correction_N = corrections[static_cast<std::size_t>(rows.fold[i])]->evaluate(point.data());
    }
    const double force_N = rows.predicted_N(common, i, inner_radius, correction_N);
    const double error = common.jnd.error_over_jnd(force_N, rows.force_N(row));
    errors.add(static_cast<std::size_t>(rows.fold[i]), error * robust_scale(error));
    add(std::abs(force_N - rows.force_N(row)), force_N, std::max(0.0, rows.distance[i] - inner_radius));
  }
  return errors;
}

std::optional<ErrorBound> BoundEstimator::fit() const {
  if (rows_.size() < kFewest) return std::nullopt;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(3, 3);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(3);
  for (const Row& one : rows_) {
    const double scale = 1.0 / jnd_.at(one.predicted_N);
    const Eigen::Vector3d row = scale * Eigen::Vector3d(1.0, std::abs(one.predicted_N), one.beyond);
    gram += row * row.transpose();
    right += row * scale * one.error_N;
  }
  const Eigen::VectorXd shape = solve_non_negative(gram, right);
  const double least_per_distance_N = kLeastPerDistance * largest_force_N_;
  ErrorBound bound{std::max(shape(0), kLeastShape_N), shape(1), std::max(shape(2), least_per_distance_N)};
  std::vector<double> ratios;
  for (const Row& one : rows_) ratios.push_back(one.error_N / bound.at(one.predicted_N, one.beyond));
  // The smallest factor that covers ceil((n + 1) 97.5 %) of them.
  const auto n = static_cast<double>(ratios.size());
  const auto rank = std::min(ratios.size() - 1, static_cast<std::size_t>(std::ceil((n + 1.0) * kCoverage)) - 1);
  std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(rank), ratios.end());
  const double factor = ratios[rank];
  bound.floor_N = std::max(factor * bound.floor_N, kForceFloor_N);
  bound.per_force = std::max(factor * bound.per_force, strokes_ < kFewStrokes ? kLeastPerForce : 0.0);
  // One unit beyond the data nothing is known but the range of the force.
  bound.per_distance_N =
      std::clamp(factor * bound.per_distance_N, least_per_distance_N, std::max(least_per_distance_N, largest_force_N_));
  return bound;
}

}  // namespace palpate
