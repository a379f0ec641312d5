#include "models/fit/select_strength.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "engine/tick/sensor_identification.h"
#include "models/training/trend_regression.h"

namespace palpate {
namespace {

// More rows give the same selection.
constexpr std::size_t kLeftOutRows = 5000;
// One or two presses do not show how the next one differs. The bound is then at least 5 % of the force, the difference
// between two specimens of a cast silicone (Dawood et al. 2026).
constexpr std::size_t kFewPresses = 3;
constexpr double kLeastPerForce = 0.05;

CrossValidationRows left_out_rows(const ModelData& common, const TrendRows& rows, const Eigen::MatrixXd& row_features,
                                  const CrossValidated& left_out, const TrendProblem& problem) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < rows.count(); i += rows.count() / kLeftOutRows + 1) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rows.fold(a) < rows.fold(b); });
  const auto n = static_cast<Eigen::Index>(order.size());
  CrossValidationRows out;
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
constexpr double kCoverage = 0.975;
constexpr double kLeastPerDistance = 0.25;  // of the largest force
constexpr double kLeastShape_N = 1e-3;      // above 0, so that the factor enlarges it

constexpr Eigen::Index kLeftOutSites = 1500;  // a tenth of a second for each fold

StrengthInput strength_input(const PreparedTraining& prepared) {
  StrengthInput input{*prepared.left_out, prepared.folds, KernelKind::cubic, prepared.common.jnd};
  input.correction_limit_N = prepared.common.correction_limit_N;
  input.lowest_force_N = prepared.common.lowest_force_N;
  return input;
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

void select_strength(PreparedTraining& prepared, const TrendRows& rows, const Eigen::MatrixXd& row_features,
                     const CrossValidated& left_out, const TrendProblem& problem, std::size_t strokes) {
  ModelData& common = prepared.common;
  prepared.left_out = left_out_rows(common, rows, row_features, left_out, problem);
  prepared.folds = static_cast<int>(left_out.solutions.cols());
  prepared.strokes = strokes;
  find_distances(*prepared.left_out, prepared.folds);
  StrengthInput input = strength_input(prepared);
  input.least_radius = common.cover.inner_radius;
  input.outer_to_inner = common.cover.outer_radius / common.cover.inner_radius;
  prepared.strength = choose_strength(input);
  prepared.sites.smoothing = prepared.strength->smoothing;
  prepared.sites.strength = prepared.strength->strength;
  common.cover.inner_radius = prepared.strength->inner_radius;
  common.cover.outer_radius = input.outer_to_inner * prepared.strength->inner_radius;
}

Sites sites_without(const PreparedTraining& prepared, int fold) {
  const CrossValidationRows& rows = *prepared.left_out;
  std::vector<Eigen::Index> others;
  for (std::size_t i = 0; i < rows.fold.size(); ++i) {
    if (rows.fold[i] != fold) others.push_back(static_cast<Eigen::Index>(i));
  }
  Sites sites;
  sites.points = rows.points(Eigen::all, others);
  sites.target_N = rows.force_N(others) - rows.trend_N(others, fold);
  sites.row_scale = rows.row_scale(others);
  for (Eigen::Index i = 0; i < sites.count(); ++i) {
    const bool no_force = rows.no_force[static_cast<std::size_t>(others[static_cast<std::size_t>(i)])] != 0;
    if (no_force) sites.target_N(i) = std::min(0.0, sites.target_N(i));
  }
  sites.smoothing = prepared.sites.smoothing;
  sites.strength = prepared.sites.strength;
  return even_subset(sites, kLeftOutSites);
}

std::vector<CrossValidationPrediction> cross_validate(const PreparedTraining& prepared,
                                                      const std::vector<CorrectionPtr>& corrections) {
  const CrossValidationRows& rows = *prepared.left_out;
  const StrengthInput input = strength_input(prepared);
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
    const double force_N = cross_validated_force_N(input, i, trust, correction_N);
    predictions.push_back({std::abs(force_N - rows.force_N(row)), rows.force_N(row), force_N, rows.distance[i]});
  }
  return predictions;
}

std::optional<ErrorBound> bound_of(const PreparedTraining& prepared,
                                   const std::vector<CrossValidationPrediction>& errors) {
  const ModelData& common = prepared.common;
  auto bound = calibrate_bound(errors, common.cover.inner_radius, common.jnd, common.largest_force_N);
  if (bound && prepared.strokes < kFewPresses) bound->per_force = std::max(bound->per_force, kLeastPerForce);
  return bound;
}

}  // namespace palpate
