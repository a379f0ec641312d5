#include "models/fit/decide_strength.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "engine/tick/sensor_identification.h"
#include "models/training/trend_regression.h"

namespace palpate {
namespace {

// More tell the same.
constexpr std::size_t kLeftOutRows = 5000;
// One or two presses say nothing of how the next differs: 5 % of the force, as two
// specimens of a cast silicone do (Dawood et al. 2026).
constexpr std::size_t kFewPresses = 3;
constexpr double kLeastPerForce = 0.05;

LeftOutRows left_out_rows(const ModelData& common, const TrendRows& rows, const Eigen::MatrixXd& row_features,
                          const LeftOutTrend& left_out, const TrendProblem& problem) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < rows.count(); i += rows.count() / kLeftOutRows + 1) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rows.fold(a) < rows.fold(b); });
  const auto n = static_cast<Eigen::Index>(order.size());
  LeftOutRows out;
  out.points.resize(row_features.rows(), n);
  for (Eigen::VectorXd* values : {&out.force_N, &out.depth_m, &out.row_scale}) values->resize(n);
  out.trend_N.resize(n, left_out.solutions.cols());
  for (Eigen::Index k = 0; k < n; ++k) {
    const std::size_t i = order[static_cast<std::size_t>(k)];
    const auto row = static_cast<Eigen::Index>(i);
    out.points.col(k) = (row_features.col(row) - common.offset).cwiseQuotient(common.scale);
    out.force_N(k) = rows.force_N(i);
    out.depth_m(k) = rows.depth_m(i);
    out.row_scale(k) = row_scale(problem.weighting, problem.jnd, rows.force_N(i));
    out.trend_N.row(k) =
        Eigen::Map<const Eigen::RowVectorXd>(rows.row(i), left_out.solutions.rows()) * left_out.solutions;
    out.fold.push_back(rows.fold(i));
    out.no_force.push_back(std::abs(rows.force_N(i)) <= problem.force_noise_floor_N ? 1 : 0);
  }
  return out;
}

constexpr std::size_t kFewest = 50;
constexpr double kHeld = 0.975;
constexpr double kLeastPerDistance = 0.25;  // of the largest force
constexpr double kLeastShape_N = 1e-3;      // something is left to multiply

}  // namespace

std::optional<ErrorBound> calibrate_bound(const std::vector<LeftOutPrediction>& predictions, double inner_radius,
                                          const JndLine& jnd, double largest_force_N) {
  if (predictions.size() < kFewest) return std::nullopt;
  const auto beyond = [&](const LeftOutPrediction& one) { return std::max(0.0, one.distance - inner_radius); };
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(3, 3);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(3);
  for (const LeftOutPrediction& one : predictions) {
    const double scale = 1.0 / jnd.at(one.predicted_N);
    const Eigen::Vector3d row = scale * Eigen::Vector3d(1.0, one.predicted_N, beyond(one));
    gram += row * row.transpose();
    right += row * scale * one.error_N;
  }
  const Eigen::VectorXd shape = solve_non_negative(gram, right);
  ErrorBound bound{std::max(shape(0), kLeastShape_N), shape(1),
                   std::max(shape(2), kLeastPerDistance * largest_force_N)};
  std::vector<double> ratios;
  for (const LeftOutPrediction& one : predictions) {
    ratios.push_back(one.error_N / bound.at(one.predicted_N, beyond(one)));
  }
  // The smallest that holds ceil((n + 1) 97.5 %) of them.
  const auto n = static_cast<double>(ratios.size());
  const auto rank = std::min(ratios.size() - 1, static_cast<std::size_t>(std::ceil((n + 1.0) * kHeld)) - 1);
  std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(rank), ratios.end());
  const double factor = ratios[rank];
  bound.floor_N = std::max(factor * bound.floor_N, kForceFloor_N);
  bound.per_force *= factor;
  bound.per_distance_N = std::max(factor * bound.per_distance_N, kLeastPerDistance * largest_force_N);
  return bound;
}

void decide_strength(PreparedTraining& prepared, const TrendRows& rows, const Eigen::MatrixXd& row_features,
                     const LeftOutTrend& left_out, const TrendProblem& problem, std::size_t strokes) {
  ModelData& common = prepared.common;
  const LeftOutRows of_rows = left_out_rows(common, rows, row_features, left_out, problem);
  StrengthInput input{of_rows, static_cast<int>(left_out.solutions.cols()), KernelKind::cubic, problem.jnd};
  input.correction_limit_N = common.correction_limit_N;
  input.lowest_force_N = common.lowest_force_N;
  input.least_radius = common.cover.inner_radius;
  input.outer_to_inner = common.cover.outer_radius / common.cover.inner_radius;
  prepared.strength = choose_strength(input);
  prepared.sites.smoothing = prepared.strength->smoothing;
  prepared.sites.strength = prepared.strength->strength;
  const double radius = prepared.strength->inner_radius;
  const auto bound_from = [&](const std::vector<LeftOutPrediction>& predictions) {
    auto bound = calibrate_bound(predictions, radius, problem.jnd, common.largest_force_N);
    if (bound && strokes < kFewPresses) bound->per_force = std::max(bound->per_force, kLeastPerForce);
    return bound;
  };
  common.error_bound = bound_from(prepared.strength->predictions);
  prepared.trend_bound = bound_from(prepared.strength->trend_predictions);
  common.cover.inner_radius = radius;
  common.cover.outer_radius = input.outer_to_inner * radius;
}

}  // namespace palpate
