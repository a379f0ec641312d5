#include "models/solve/choose_smoothing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "engine/base/parallel.h"
#include "models/solve/lapack.h"
#include "models/solve/projected_kernel.h"

namespace palpate {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kFewestGroups = 4;

// I - H = V diag(smoothing / (e + smoothing)) V^T on the complement of q.
class Smoother {
 public:
  bool prepare(const Sites& sites, const ProjectedKernel& kernel) {
    // The tail's directions get an eigenvalue above all others, to be told apart.
    vectors_ = kernel.matrix(10.0 * kernel.mean_eigenvalue() * static_cast<double>(sites.count()), 0.0);
    const BlasThreads threads(thread_count());
    if (!symmetric_eigen(vectors_, values_)) return false;
    const Eigen::Index rank = sites.count() - kernel.tail_rank();
    values_ = values_.head(rank).cwiseMax(0.0).eval();
    vectors_ = vectors_.leftCols(rank).eval();
    z_ = vectors_.transpose() * kernel.data();
    std::map<int, std::vector<Eigen::Index>> members;
    for (std::size_t i = 0; i < sites.group.size(); ++i)
      members[sites.group[i]].push_back(static_cast<Eigen::Index>(i));
    for (const auto& [number, rows] : members) groups_.push_back(vectors_(rows, Eigen::all));
    return true;
  }

  bool has_groups() const { return groups_.size() >= kFewestGroups; }
  bool empty() const { return values_.size() == 0; }

  double generalised(double smoothing) const {
    const Eigen::VectorXd left = shares_left(smoothing);
    const double freedom = left.sum();
    return static_cast<double>(vectors_.rows()) * left.cwiseProduct(z_).squaredNorm() / (freedom * freedom);
  }

  // exp(2 / rank) of the negative log likelihood, the scale of the prior
  // profiled out.
  double likelihood(double smoothing) const {
    const Eigen::ArrayXd variances = values_.array() + smoothing;
    return (z_.array().square() / variances).mean() * std::exp(variances.log().mean());
  }
  Eigen::Index rank() const { return values_.size(); }

  double by_group(double smoothing) const {
    const Eigen::VectorXd left = shares_left(smoothing);
    double sum = 0.0;
    for (const Eigen::MatrixXd& rows : groups_) {
      const Eigen::MatrixXd scaled = rows * left.cwiseSqrt().asDiagonal();
      Eigen::MatrixXd block(rows.rows(), rows.rows());
      multiply(scaled, false, scaled, true, 1.0, 0.0, block);
      Eigen::VectorXd error = rows * left.cwiseProduct(z_);
      if (!cholesky_in_place(block)) return kInfinity;
      cholesky_solve(block, error);
      sum += error.squaredNorm();
    }
    return sum / static_cast<double>(vectors_.rows());
  }

 private:
  Eigen::VectorXd shares_left(double smoothing) const { return (smoothing / (values_.array() + smoothing)).matrix(); }

  Eigen::MatrixXd vectors_;
  Eigen::VectorXd values_;
  Eigen::VectorXd z_;
  std::vector<Eigen::MatrixXd> groups_;  // rows of vectors_ of each stroke
};

// Where the criterion is flat the noise is too small to matter, and the most
// smoothing among equals gives the best conditioned system.
constexpr double kAsGood = 1.01;

// The smallest criterion over decades, then over quarters of a decade; of
// those as good, the most smoothing.
template <typename Criterion>
SmoothingChoice search(double unit, double smallest, const Criterion& criterion, double as_good = kAsGood) {
  std::map<double, double> values;  // criterion by exponent
  const auto look_at = [&](double exponent) {
    const double smoothing = unit * std::pow(10.0, exponent);
    if (smoothing >= smallest) values[exponent] = criterion(smoothing);
  };
  const auto most_of_the_best = [&] {
    double lowest = kInfinity;
    for (const auto& [exponent, value] : values) lowest = std::min(lowest, value);
    SmoothingChoice best{smallest, kInfinity, false};
    double best_exponent = 0.0;
    for (const auto& [exponent, value] : values)
      if (value < kInfinity && value <= as_good * lowest) {
        best = {unit * std::pow(10.0, exponent), value, false};
        best_exponent = exponent;
      }
    return std::pair(best, best_exponent);
  };
  for (int decade = -12; decade <= 2; ++decade) look_at(decade);
  const auto [coarse, centre] = most_of_the_best();
  if (coarse.criterion == kInfinity) return coarse;
  for (const int quarter : {-3, -2, -1, 1, 2, 3}) look_at(centre + 0.25 * quarter);
  return most_of_the_best().first;
}

}  // namespace

Result<SmoothingChoice> choose_smoothing(const Sites& sites, KernelKind kernel) {
  const Sites subset = even_subset(sites, kSmoothingSubset);
  const ProjectedKernel projected(subset, kernel);
  const double unit = projected.mean_eigenvalue();
  const double smallest = projected.smallest_smoothing();
  Smoother smoother;
  if (!smoother.prepare(subset, projected))
    return Error{"the eigendecomposition did not converge; check the recording for extreme values"};
  if (smoother.empty()) return SmoothingChoice{smallest, 0.0, false};
  const BlasThreads one_thread(1);
  SmoothingChoice choice{0.0, kInfinity, false};
  if (smoother.has_groups()) {
    choice = search(unit, smallest, [&](double s) { return smoother.by_group(s); });
    choice.by_group = true;
  }
  if (choice.criterion == kInfinity) choice = search(unit, smallest, [&](double s) { return smoother.generalised(s); });
  // Within two units of log likelihood.
  const double as_good = 1.0 + 4.0 / static_cast<double>(smoother.rank());
  const SmoothingChoice likely = search(
      unit, smallest, [&](double s) { return smoother.likelihood(s); }, as_good);
  if (likely.smoothing > choice.smoothing) {
    choice.smoothing = likely.smoothing;
    choice.criterion = choice.by_group ? smoother.by_group(likely.smoothing) : smoother.generalised(likely.smoothing);
  }
  return choice;
}

}  // namespace palpate
