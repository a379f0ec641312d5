#include "models/solve/choose_smoothing.h"

#include <cmath>
#include <vector>

#include "models/linear/lapack.h"
#include "models/solve/projected_kernel.h"

namespace palpate {
namespace {

// The largest subset: its eigendecomposition takes some 40 ms.
constexpr Eigen::Index kSmoothingSubset = 500;
// The range of the search relative to the mean eigenvalue, in quarters of a decade.
constexpr int kLowestQuarter = -48;
constexpr int kHighestQuarter = 8;

}  // namespace

Result<double> choose_smoothing(const Sites& sites, KernelKind kernel) {
  const Sites subset = even_subset(sites, kSmoothingSubset);
  const ProjectedKernel projected(subset, kernel);
  const double unit = projected.mean_eigenvalue();
  const Eigen::Index rank = subset.count() - projected.tail_rank();
  if (rank == 0) return projected.smallest_smoothing();
  // The directions of the tail get an eigenvalue above all others, so that they come last.
  Eigen::MatrixXd vectors = projected.matrix(10.0 * unit * static_cast<double>(subset.count()), 0.0);
  Eigen::VectorXd values;
  const BlasThreads one_thread(1);
  if (!symmetric_eigen(vectors, values))
    return Error{"the eigendecomposition did not converge; check the recording for extreme values"};
  const Eigen::ArrayXd eigenvalues = values.head(rank).cwiseMax(0.0).array();
  const Eigen::ArrayXd z_squared = (vectors.leftCols(rank).transpose() * projected.data()).array().square();
  // exp(2 L / rank), where L is the negative log likelihood.
  const auto likelihood = [&](double smoothing) {
    const Eigen::ArrayXd variances = eigenvalues + smoothing;
    return (z_squared / variances).mean() * std::exp(variances.log().mean());
  };
  // The largest smoothing within two units of log likelihood of the best is chosen: it gives the best conditioned
  // system.
  const double as_good = 1.0 + 4.0 / static_cast<double>(rank);
  double chosen = projected.smallest_smoothing();
  double lowest = likelihood(chosen);
  std::vector<double> tried;
  for (int quarter = kLowestQuarter; quarter <= kHighestQuarter; ++quarter) {
    const double smoothing = unit * std::pow(10.0, 0.25 * quarter);
    if (smoothing < projected.smallest_smoothing()) continue;
    tried.push_back(smoothing);
    lowest = std::min(lowest, likelihood(smoothing));
  }
  for (const double smoothing : tried) {
    if (likelihood(smoothing) <= as_good * lowest) chosen = smoothing;
  }
  return chosen;
}

Result<double> smoothing_of(const Sites& sites, KernelKind kernel) {
  if (is_smoothing_selected(sites, kernel)) return *sites.smoothing;
  return choose_smoothing(sites, kernel);
}

}  // namespace palpate
