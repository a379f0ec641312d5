#include "models/fit/calibrate_bound.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "models/training/trend_regression.h"

namespace palpate {
namespace {

constexpr std::size_t kFewest = 50;
constexpr double kHeld = 0.975;
constexpr double kLeastPerDistance = 0.25;  // of the largest force
constexpr double kLeastFloor_N = 1e-3;

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
  ErrorBound bound{std::max(shape(0), kLeastFloor_N), shape(1),
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
  bound.floor_N = std::max(factor * bound.floor_N, kLeastFloor_N);
  bound.per_force *= factor;
  bound.per_distance_N = std::max(factor * bound.per_distance_N, kLeastPerDistance * largest_force_N);
  return bound;
}

}  // namespace palpate
