#include "models/fit/bound_calibration.h"

#include <algorithm>
#include <cmath>

#include "engine/tick/sensor_identification.h"
#include "models/linear/non_negative.h"

namespace palpate {
namespace {

// One or two presses do not show how the next one differs. The bound is then at least 5 % of the force, the difference
// between two specimens of a cast silicone (Dawood et al. 2026).
constexpr std::size_t kFewPresses = 3;
constexpr double kLeastPerForce = 0.05;
constexpr std::size_t kFewest = 50;
constexpr double kCoverage = 0.975;
constexpr double kLeastPerDistance = 0.25;  // of the largest force
constexpr double kLeastShape_N = 1e-3;      // above 0, so that the factor enlarges it

constexpr Eigen::Index kLeftOutSites = 1500;  // a tenth of a second for each fold

// The cross-validated errors of a model. Rows are omitted where there is no other fold.
std::vector<CrossValidationPrediction> predictions_of(const PreparedTraining& prepared,
                                                      const std::vector<CorrectionPtr>& corrections) {
  const CrossValidationRows& rows = *prepared.left_out;
  const DomainCover& cover = prepared.common.cover;
  std::vector<CrossValidationPrediction> predictions;
  for (std::size_t i = 0; i < rows.fold.size(); ++i) {
    if (!std::isfinite(rows.distance[i])) continue;
    const auto row = static_cast<Eigen::Index>(i);
    double correction_N = 0.0;
    if (!corrections.empty()) {
      const Eigen::VectorXd point = rows.points.col(row);
      correction_N = corrections[static_cast<std::size_t>(rows.fold[i])]->evaluate(point.data());
    }
    const double trust = trust_at_distance(rows.distance[i], cover.inner_radius, cover.outer_radius);
    const double force_N = rows.predicted_N(prepared.common, i, trust, correction_N);
    predictions.push_back({std::abs(force_N - rows.force_N(row)), force_N, rows.distance[i]});
  }
  return predictions;
}

}  // namespace

std::optional<ErrorBound> calibrate_bound(const std::vector<CrossValidationPrediction>& predictions,
                                          double inner_radius, const JndLine& jnd, double largest_force_N) {
  if (predictions.size() < kFewest) return std::nullopt;
  const auto beyond = [&](const CrossValidationPrediction& one) { return std::max(0.0, one.distance - inner_radius); };
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(3, 3);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(3);
  for (const CrossValidationPrediction& one : predictions) {
    const double scale = 1.0 / jnd.at(one.predicted_N);
    const Eigen::Vector3d row = scale * Eigen::Vector3d(1.0, one.predicted_N, beyond(one));
    gram += row * row.transpose();
    right += row * scale * one.error_N;
  }
  const Eigen::VectorXd shape = solve_non_negative(gram, right);
  ErrorBound bound{std::max(shape(0), kLeastShape_N), shape(1),
                   std::max(shape(2), kLeastPerDistance * largest_force_N)};
  std::vector<double> ratios;
  for (const CrossValidationPrediction& one : predictions) {
    ratios.push_back(one.error_N / bound.at(one.predicted_N, beyond(one)));
  }
  // The smallest factor that covers ceil((n + 1) 97.5 %) of them.
  const auto n = static_cast<double>(ratios.size());
  const auto rank = std::min(ratios.size() - 1, static_cast<std::size_t>(std::ceil((n + 1.0) * kCoverage)) - 1);
  std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(rank), ratios.end());
  const double factor = ratios[rank];
  bound.floor_N = std::max(factor * bound.floor_N, kForceFloor_N);
  bound.per_force *= factor;
  bound.per_distance_N = std::max(factor * bound.per_distance_N, kLeastPerDistance * largest_force_N);
  return bound;
}

Sites sites_without(const PreparedTraining& prepared, int fold) {
  const CrossValidationRows& rows = *prepared.left_out;
  const std::vector<Eigen::Index> others = rows.outside(fold);
  Sites sites;
  sites.points = rows.points(Eigen::all, others);
  const double strength = prepared.strength ? prepared.strength->strength : 1.0;
  sites.target_N = strength * rows.residual_N(fold)(others);
  sites.row_scale = rows.row_scale(others);
  sites.smoothing = prepared.sites.smoothing;
  return even_subset(sites, kLeftOutSites);
}

std::optional<ErrorBound> bound_of(const PreparedTraining& prepared, const std::vector<CorrectionPtr>& corrections) {
  const ModelData& common = prepared.common;
  auto bound = calibrate_bound(predictions_of(prepared, corrections), common.cover.inner_radius, common.jnd,
                               common.largest_force_N);
  if (bound && prepared.strokes < kFewPresses) bound->per_force = std::max(bound->per_force, kLeastPerForce);
  return bound;
}

}  // namespace palpate
