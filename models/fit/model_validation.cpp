#include "models/fit/model_validation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/base/parallel.h"
#include "engine/base/random_stream.h"
#include "engine/tick/sensor_identification.h"
#include "models/linear/lapack.h"
#include "models/linear/non_negative.h"
#include "models/model/domain_guard.h"
#include "models/model/rbf/polynomial_tail.h"
#include "models/model/rbf/rbf_evaluate.h"
#include "models/solve/projected_kernel.h"
#include "models/training/cross_validation.h"

namespace palpate {
namespace {

// More rows give the same selection.
constexpr std::size_t kLeftOutRows = 5000;
constexpr KernelKind kKernel = KernelKind::cubic;
constexpr Eigen::Index kCentres = 200;
constexpr int kLowestDecade = -9;  // of the smoothing, relative to the mean eigenvalue
constexpr int kHighestDecade = 1;
constexpr std::array kRadiusFactors{1.0, 2.0, 4.0, 8.0};

// One or two strokes do not show how the next one differs. The bound is then at least 5 % of the force, the difference
// between two specimens of a cast silicone (Dawood et al. 2026).
constexpr std::size_t kFewStrokes = 3;
constexpr double kLeastPerForce = 0.05;
constexpr std::size_t kFewest = 50;
constexpr double kCoverage = 0.975;
constexpr double kLeastPerDistance = 0.25;    // of the largest force
constexpr double kLeastShape_N = 1e-3;        // above 0, so that the factor enlarges it
constexpr Eigen::Index kLeftOutSites = 1500;  // a tenth of a second for each fold

// The fits without each fold, for any smoothing. The rows are sorted by fold.
class LeftOutFits {
 public:
  explicit LeftOutFits(const CrossValidationRows& rows)
      : rows_(rows),
        centres_(random_centres(rows.points)),
        kernel_(kKernel, centres_, Eigen::VectorXd::Ones(centres_.cols())),
        penalty_(kernel_.matrix(kernel_.mean_eigenvalue(), kernel_.smallest_smoothing())),
        design_(rows.points.cols(),
                centres_.cols() + tail_size(tail_degree(kKernel), static_cast<int>(rows.points.rows()))),
        folds_(static_cast<std::size_t>(rows.folds())) {
    Eigen::MatrixXd kernel(design_.rows(), centres_.cols());
    kernel_matrix(kKernel, PointArrays(rows.points), centres_, kernel);
    kernel_.project_rows(kernel);
    design_ << kernel, tail_matrix(tail_degree(kKernel), rows.points);
    parallel_for(rows.folds(), [&](int fold) { gather(fold); });
    Eigen::MatrixXd total = Eigen::MatrixXd::Zero(design_.cols(), design_.cols());
    for (const Fold& fold : folds_) total += fold.gram;
    for (Fold& fold : folds_) fold.gram = total - fold.gram;
  }

  // The mean eigenvalue of the kernel between all scaled rows, estimated at the centres: the unit of the smoothing.
  double unit() const {
    const double mean_scale = rows_.row_scale.squaredNorm() / static_cast<double>(rows_.row_scale.size());
    return mean_scale > 0.0 ? kernel_.mean_eigenvalue() * mean_scale : 1.0;
  }

  // Predicts the correction at every row from the rows of the other folds.
  Eigen::VectorXd predictions(double smoothing) const {
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

 private:
  struct Fold {
    Eigen::Index first = 0;
    Eigen::Index count = 0;
    Eigen::MatrixXd gram;   // first of its own rows, then of all others; the lower triangle
    Eigen::VectorXd right;  // of all others, for the residual of the trend without this fold
  };

  static Eigen::MatrixXd random_centres(const Eigen::MatrixXd& points) {
    std::vector<Eigen::Index> order(static_cast<std::size_t>(points.cols()));
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    SplitMix64 random(1);
    order.resize(draw_first(order, std::clamp<Eigen::Index>(points.cols() / 4, 1, kCentres), random));
    return points(Eigen::all, order);
  }

  void gather(int fold) {
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

  const CrossValidationRows& rows_;
  Eigen::MatrixXd centres_;
  ProjectedKernel kernel_;   // of the centres
  Eigen::MatrixXd penalty_;  // its lower triangle
  Eigen::MatrixXd design_;   // [K P, G]
  std::vector<Fold> folds_;
};

// A candidate.
struct Variant : CorrectionChoice {
  FoldErrors errors;
};

}  // namespace

std::vector<Eigen::Index> CrossValidationRows::outside(int without) const {
  std::vector<Eigen::Index> others;
  for (std::size_t i = 0; i < fold.size(); ++i) {
    if (fold[i] != without) others.push_back(static_cast<Eigen::Index>(i));
  }
  return others;
}

Eigen::VectorXd CrossValidationRows::residual_N(int without) const {
  Eigen::VectorXd residual_N = force_N - trend_N.col(without);
  for (Eigen::Index i = 0; i < residual_N.size(); ++i) {
    if (no_force[static_cast<std::size_t>(i)]) residual_N(i) = std::min(0.0, residual_N(i));
  }
  return residual_N;
}

double CrossValidationRows::predicted_N(const ModelData& common, std::size_t i, double inner_radius, double h) const {
  const double outer_to_inner = common.cover.outer_radius / common.cover.inner_radius;
  const double trust = trust_at_distance(distance[i], inner_radius, outer_to_inner * inner_radius);
  const double limit_N = common.correction_limit_N;
  const double trend = trend_N(static_cast<Eigen::Index>(i), fold[i]);
  return std::max(common.lowest_force_N, trend + trust * std::clamp(h, -limit_N, limit_N));
}

void find_distances(CrossValidationRows& rows) {
  rows.distance.assign(rows.fold.size(), std::numeric_limits<double>::infinity());
  parallel_for(rows.folds(), [&](int fold) {
    const std::vector<Eigen::Index> others = rows.outside(fold);
    if (others.empty()) return;
    const NearestDistance nearest(rows.points(Eigen::all, others));
    for (std::size_t i = 0; i < rows.fold.size(); ++i) {
      if (rows.fold[i] != fold) continue;
      const Eigen::VectorXd point = rows.points.col(static_cast<Eigen::Index>(i));
      rows.distance[i] = std::sqrt(nearest.nearest_squared(point.data()));
    }
  });
}

CrossValidationRows cross_validation_rows(const ModelData& common, const TrendRows& rows,
                                          const Eigen::MatrixXd& row_features, const Eigen::MatrixXd& left_out_trends) {
  const TrendProblem& problem = rows.problem();
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < rows.count(); i += rows.count() / kLeftOutRows + 1) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rows[a].fold < rows[b].fold; });
  const auto n = static_cast<Eigen::Index>(order.size());
  CrossValidationRows out;
  out.points.resize(row_features.rows(), n);
  for (Eigen::VectorXd* values : {&out.force_N, &out.depth_m, &out.row_scale}) values->resize(n);
  out.trend_N.resize(n, left_out_trends.cols());
  for (Eigen::Index k = 0; k < n; ++k) {
    const TrendRow& row = rows[order[static_cast<std::size_t>(k)]];
    const auto at = static_cast<Eigen::Index>(order[static_cast<std::size_t>(k)]);
    out.points.col(k) = (row_features.col(at) - common.offset).cwiseQuotient(common.scale);
    out.force_N(k) = row.force_N;
    out.depth_m(k) = row.depth_m;
    out.row_scale(k) = row_scale(problem.weighting, problem.jnd, row.force_N);
    out.trend_N.row(k) = rows.terms().row(at) * left_out_trends;
    out.fold.push_back(row.fold);
    out.no_force.push_back(std::abs(row.force_N) <= problem.force_noise_floor_N ? 1 : 0);
  }
  find_distances(out);
  return out;
}

CorrectionChoice choose_correction(const CrossValidationRows& rows, const ModelData& common) {
  const double least_radius = common.cover.inner_radius;
  const auto folds = static_cast<std::size_t>(rows.folds());
  if (rows.fold.size() < 2 || folds < 2) return {.inner_radius = least_radius};
  const BlasThreads one_thread(1);
  const LeftOutFits fits(rows);
  const std::vector<double> deepest_m =
      deepest_elsewhere_m(rows.fold, {rows.depth_m.data(), rows.fold.size()}, rows.folds());
  // Adds the errors of a candidate. `h`: its correction at every row.
  const auto score = [&](Variant& variant, const Eigen::VectorXd& h) {
    for (std::size_t i = 0; i < rows.fold.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const auto fold = static_cast<std::size_t>(rows.fold[i]);
      if (rows.depth_m(row) > deepest_m[fold]) continue;
      const double force_N = rows.predicted_N(common, i, variant.inner_radius, h(row));
      const double error = common.jnd.error_over_jnd(force_N, rows.force_N(row));
      variant.errors.add(fold, error * robust_scale(error));
    }
  };
  std::vector<Variant> variants{{{false, fits.unit(), least_radius}, folds}};  // no correction
  for (int decade = kHighestDecade; decade >= kLowestDecade; --decade) {
    for (const double factor : kRadiusFactors) {
      variants.push_back({{true, fits.unit() * std::pow(10.0, decade), factor * least_radius}, folds});
    }
  }
  score(variants.front(), Eigen::VectorXd::Zero(rows.force_N.size()));
  parallel_for(kHighestDecade - kLowestDecade + 1, [&](int part) {
    const auto first = variants.begin() + 1 + static_cast<std::ptrdiff_t>(kRadiusFactors.size()) * part;
    const Eigen::VectorXd h = fits.predictions(first->smoothing);
    for (std::size_t i = 0; i < kRadiusFactors.size(); ++i) score(first[static_cast<std::ptrdiff_t>(i)], h);
  });
  // From the simplest to the most complex: no correction, then by growing reach and, with the same reach, by falling
  // smoothing. (Similar strokes do not identify the reach.)
  std::ranges::stable_sort(variants.begin() + 1, variants.end(), {}, &Variant::inner_radius);
  const Variant& chosen = variants[simplest_adequate(errors_of(variants))];
  CorrectionChoice choice = chosen;
  choice.trend_error_over_jnd = variants.front().errors.rms_at_mean_score();
  choice.error_over_jnd = chosen.errors.rms_at_mean_score();
  return choice;
}

Sites sites_without(const CrossValidationRows& rows, int fold, double smoothing) {
  const std::vector<Eigen::Index> others = rows.outside(fold);
  Sites sites{rows.points(Eigen::all, others), rows.residual_N(fold)(others), rows.row_scale(others)};
  sites.smoothing = smoothing;
  return even_subset(sites, kLeftOutSites);
}

std::optional<ErrorBound> calibrate_bound(const std::vector<CrossValidationPrediction>& predictions, const JndLine& jnd,
                                          double largest_force_N) {
  if (predictions.size() < kFewest) return std::nullopt;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(3, 3);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(3);
  for (const CrossValidationPrediction& one : predictions) {
    const double scale = 1.0 / jnd.at(one.predicted_N);
    const Eigen::Vector3d row = scale * Eigen::Vector3d(1.0, std::abs(one.predicted_N), one.beyond);
    gram += row * row.transpose();
    right += row * scale * one.error_N;
  }
  const Eigen::VectorXd shape = solve_non_negative(gram, right);
  ErrorBound bound{std::max(shape(0), kLeastShape_N), shape(1),
                   std::max(shape(2), kLeastPerDistance * largest_force_N)};
  std::vector<double> ratios;
  for (const CrossValidationPrediction& one : predictions) {
    ratios.push_back(one.error_N / bound.at(one.predicted_N, one.beyond));
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

std::optional<ErrorBound> bound_of(const CrossValidationRows& rows, const ModelData& common,
                                   const std::vector<CorrectionPtr>& corrections) {
  const double inner_radius = common.cover.inner_radius;
  std::vector<CrossValidationPrediction> predictions;
  for (std::size_t i = 0; i < rows.fold.size(); ++i) {
    if (!std::isfinite(rows.distance[i])) continue;  // there is no other fold
    const auto row = static_cast<Eigen::Index>(i);
    double correction_N = 0.0;
    if (!corrections.empty()) {
      const Eigen::VectorXd point = rows.points.col(row);
      correction_N = corrections[static_cast<std::size_t>(rows.fold[i])]->evaluate(point.data());
    }
    const double force_N = rows.predicted_N(common, i, inner_radius, correction_N);
    predictions.push_back(
        {std::abs(force_N - rows.force_N(row)), force_N, std::max(0.0, rows.distance[i] - inner_radius)});
  }
  auto bound = calibrate_bound(predictions, common.jnd, common.largest_force_N);
  if (bound && rows.strokes < kFewStrokes) bound->per_force = std::max(bound->per_force, kLeastPerForce);
  return bound;
}

}  // namespace palpate
