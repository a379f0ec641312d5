#include "models/fit/correction_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "engine/base/parallel.h"
#include "engine/base/random_stream.h"
#include "models/correction/projected_kernel.h"
#include "models/linear/lapack.h"
#include "models/model/rbf/polynomial_tail.h"
#include "models/model/rbf/rbf_evaluate.h"
#include "models/samples/cross_validation.h"

namespace palpate {
namespace {

constexpr Eigen::Index kCentres = 200;
constexpr int kLowestDecade = -9;  // of the smoothing, relative to the mean eigenvalue
constexpr int kHighestDecade = 1;
constexpr std::array kRadiusFactors{1.0, 2.0, 4.0, 8.0};

Eigen::MatrixXd random_centres(const Eigen::MatrixXd& points) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(points.cols()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  SplitMix64 random(1);
  order.resize(draw_first(order, std::clamp<Eigen::Index>(points.cols() / 4, 1, kCentres), random));
  return points(Eigen::all, order);
}

struct ScoredCorrection : CorrectionChoice {
  FoldErrors errors;
};

// The fits of a correction without each fold, for any smoothing. The rows are sorted by fold.
class LeftOutFits {
 public:
  explicit LeftOutFits(const ResidualRows& rows);

  // Predicts the correction at every row from the rows of the other folds.
  Eigen::VectorXd predict(double smoothing) const;

  // The mean eigenvalue of the kernel between all scaled rows, estimated at the centres: the unit of the smoothing.
  double unit() const {
    const double mean_scale = rows_.row_scale.squaredNorm() / static_cast<double>(rows_.row_scale.size());
    return mean_scale > 0.0 ? kernel_.mean_eigenvalue() * mean_scale : 1.0;
  }

 private:
  struct Fold {
    Eigen::Index first = 0;
    Eigen::Index count = 0;
    Eigen::MatrixXd gram;   // first of its own rows, then of all others; the lower triangle
    Eigen::VectorXd right;  // of all others, for the residual of the trend without this fold
  };
  void gather(int fold);

  const ResidualRows& rows_;
  Eigen::MatrixXd centres_;
  ProjectedKernel kernel_;   // of the centres
  Eigen::MatrixXd penalty_;  // its lower triangle
  Eigen::MatrixXd design_;   // [K P, G]
  std::vector<Fold> folds_;
};

LeftOutFits::LeftOutFits(const ResidualRows& rows)
    : rows_(rows),
      centres_(random_centres(rows.points)),
      kernel_(rows.kernel, centres_, Eigen::VectorXd::Ones(centres_.cols())),
      penalty_(kernel_.matrix(kernel_.mean_eigenvalue(), kernel_.smallest_smoothing())),
      design_(rows.points.cols(),
              centres_.cols() + tail_size(tail_degree(rows.kernel), static_cast<int>(rows.points.rows()))),
      folds_(static_cast<std::size_t>(rows.folds())) {
  Eigen::MatrixXd kernel(design_.rows(), centres_.cols());
  kernel_matrix(rows.kernel, PointArrays(rows.points), centres_, kernel);
  kernel_.project_rows(kernel);
  design_ << kernel, tail_matrix(tail_degree(rows.kernel), rows.points);
  parallel_for(rows.folds(), [&](int fold) { gather(fold); });
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(design_.cols(), design_.cols());
  for (const Fold& fold : folds_) total += fold.gram;
  for (Fold& fold : folds_) fold.gram = total - fold.gram;
}

void LeftOutFits::gather(int fold) {
  Fold& mine = folds_[static_cast<std::size_t>(fold)];
  const auto& of = rows_.fold;
  const auto [from, to] = std::equal_range(of.begin(), of.end(), fold);
  mine.first = from - of.begin();
  mine.count = to - from;
  mine.gram = Eigen::MatrixXd::Zero(design_.cols(), design_.cols());
  mine.right = Eigen::VectorXd::Zero(design_.cols());
  if (mine.count > 0) {
    Eigen::MatrixXd part = design_.middleRows(mine.first, mine.count);
    part.array().colwise() *= rows_.row_scale.segment(mine.first, mine.count).array();
    gram(part, mine.gram);
  }
  Eigen::VectorXd left = rows_.residual_N(fold);
  left.array() *= rows_.row_scale.array().square();
  left.segment(mine.first, mine.count).setZero();
  multiply(design_, true, left, false, 1.0, 0.0, mine.right);
}

Eigen::VectorXd LeftOutFits::predict(double smoothing) const {
  Eigen::VectorXd values(design_.rows());
  for (const Fold& fold : folds_) {
    if (fold.count == 0) continue;
    Eigen::MatrixXd penalised = fold.gram;
    penalised.topLeftCorner(penalty_.rows(), penalty_.cols()).triangularView<Eigen::Lower>() += smoothing * penalty_;
    const Eigen::VectorXd coefficients = solve_with_ridge(penalised, fold.right, 1e-14);
    multiply(design_.middleRows(fold.first, fold.count), false, coefficients, false, 1.0, 0.0,
             values.segment(fold.first, fold.count));
  }
  return values;
}

}  // namespace

CorrectionChoice choose_correction(const ResidualRows& rows, const ModelData& common) {
  const double least_radius = common.cover.inner_radius;
  const auto folds = static_cast<std::size_t>(rows.folds());
  if (rows.fold.size() < 2 || folds < 2) return {.inner_radius = least_radius};
  const BlasThreads one_thread(1);
  const LeftOutFits fits(rows);
  const std::vector<double> deepest_m =
      deepest_elsewhere_m(rows.fold, {rows.depth_m.data(), rows.fold.size()}, rows.folds());
  // Adds the errors of a candidate. `h`: its correction at every row.
  const auto score = [&](ScoredCorrection& candidate, const Eigen::VectorXd& h) {
    for (std::size_t i = 0; i < rows.fold.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const auto fold = static_cast<std::size_t>(rows.fold[i]);
      if (rows.depth_m(row) > deepest_m[fold]) continue;
      const double force_N = rows.predicted_N(common, i, candidate.inner_radius, h(row));
      const double error = common.jnd.error_over_jnd(force_N, rows.force_N(row));
      candidate.errors.add(fold, error * robust_scale(error));
    }
  };
  std::vector<ScoredCorrection> candidates{{{false, fits.unit(), least_radius}, folds}};  // no correction
  for (int decade = kHighestDecade; decade >= kLowestDecade; --decade) {
    for (const double factor : kRadiusFactors) {
      candidates.push_back({{true, fits.unit() * std::pow(10.0, decade), factor * least_radius}, folds});
    }
  }
  score(candidates.front(), Eigen::VectorXd::Zero(rows.force_N.size()));
  parallel_for(kHighestDecade - kLowestDecade + 1, [&](int part) {
    const auto first = candidates.begin() + 1 + static_cast<std::ptrdiff_t>(kRadiusFactors.size()) * part;
    const Eigen::VectorXd h = fits.predict(first->smoothing);
    for (std::size_t i = 0; i < kRadiusFactors.size(); ++i) score(first[static_cast<std::ptrdiff_t>(i)], h);
  });
  const ScoredCorrection& chosen = candidates[best_score(errors_of(candidates))];
  CorrectionChoice choice = chosen;
  choice.trend_error_over_jnd = candidates.front().errors.rms_at_mean_score();
  choice.error_over_jnd = chosen.errors.rms_at_mean_score();
  return choice;
}

}  // namespace palpate
