#include "models/fit/fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "engine/base/parallel.h"
#include "engine/base/statistics.h"
#include "engine/tick/motion_estimator.h"
#include "models/correction/algebra.h"
#include "models/linear/lapack.h"
#include "models/model/correction.h"
#include "models/model/fitted_model.h"
#include "models/model/kernels.h"

namespace palpate {
namespace {

constexpr Eigen::Index kCentres = 200;
constexpr int kLowestDecade = -9;  // of the smoothing, relative to the mean eigenvalue
constexpr int kHighestDecade = 1;
constexpr std::array kRadiusFactors{1.0, 2.0, 4.0, 8.0};
constexpr std::size_t kLeastOfPhase = 5;  // rows; fewer do not show the error of a phase

struct ScoredCorrection : CorrectionChoice {
  FoldErrors errors;
};

// The fits of a correction without each fold, for any smoothing. The rows are sorted by fold.
class LeftOutFits {
 public:
  explicit LeftOutFits(const ResidualRows& rows)
      : rows_(rows),
        centres_(rows.points(Eigen::all, random_quarter(rows.points.cols(), kCentres))),
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

  // Predicts the correction at every row from the rows of the other folds.
  Eigen::VectorXd predict(double smoothing) const {
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

  // The mean eigenvalue of the kernel between all scaled rows, estimated at the centres: the unit of the smoothing.
  double unit() const {
    const double mean_scale = rows_.row_scale.squaredNorm() / static_cast<double>(rows_.row_scale.size());
    return mean_scale > 0.0 ? kernel_.mean_eigenvalue() * mean_scale : 1.0;
  }

 private:
  struct Fold {
    Eigen::Index first = 0, count = 0;
    Eigen::MatrixXd gram;   // first of its own rows, then of all others; the lower triangle
    Eigen::VectorXd right;  // of all others, for the residual of the trend without this fold
  };
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

  const ResidualRows& rows_;
  Eigen::MatrixXd centres_;
  ProjectedKernel kernel_;   // of the centres
  Eigen::MatrixXd penalty_;  // its lower triangle
  Eigen::MatrixXd design_;   // [K P, G]
  std::vector<Fold> folds_;
};

// The index, in ascending order, of the one of `count` exchangeable values that covers the next with this probability;
// the largest where none does.
std::size_t conformal_rank(std::size_t count, double probability) {
  const double rank = std::ceil((static_cast<double>(count) + 1.0) * probability);
  return std::min(count, static_cast<std::size_t>(rank)) - 1;
}

// The factor of the bound that covers 95 % of the rows of a unit, in order of time, and of each of its phases.
double factor_of(std::vector<Prediction> rows, const ErrorBound& bound) {
  const auto quantile_of_first = [&](std::size_t count) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < count; ++i)
      ratios.push_back(std::abs(rows[i].error_N) / bound.at(rows[i].predicted_N, rows[i].beyond));
    return nth_smallest(std::move(ratios), conformal_rank(count, 0.95));
  };
  double factor = quantile_of_first(rows.size());
  const std::size_t tenth = rows.size() / 10;
  if (tenth < kLeastOfPhase) return factor;
  factor = std::max(factor, quantile_of_first(tenth));
  for (double Prediction::*const phase : {&Prediction::depth_m, &Prediction::speed_m_per_s}) {
    std::ranges::stable_sort(rows, std::ranges::greater{}, phase);
    factor = std::max(factor, quantile_of_first(tenth));
  }
  return factor;
}

// The standard error of the surface of the next recording; the errors keep what it does not explain. Of a single
// recording it is that of its own surface. Each of K recordings is moved by the x_k with the least squares of error /
// J, at most half the depth; x_k (K - 1) / K are the distances of the surfaces from their mean.
double register_surfaces(std::map<int, std::vector<Prediction>>& units, const ModelData& common) {
  const std::vector<RecordingOffset>& offsets = common.provenance.offsets;
  const double own_m = offsets.empty() ? 0.0 : offsets.front().standard_error_m;
  if (offsets.size() < 2) return std::isfinite(own_m) ? own_m : 0.0;
  double squares = 0.0;
  for (auto& [unit, rows] : units) {
    const auto error_N = [&](const Prediction& one, double by_m) {
      return one.error_N + common.trend.moved_N(one.depth_m, by_m);
    };
    const auto cost = [&, &rows = rows](double by_m) {
      double sum = 0.0;
      for (const Prediction& one : rows) sum += std::pow(error_N(one, by_m) / common.jnd.at(one.predicted_N), 2);
      return BlockCosts{sum};
    };
    const double most_m = 0.5 * common.trend.reference_depth_m;
    const double by_m = estimate_offset(cost, {-most_m, most_m, 0.05 * most_m, kFinest_m}).minimum_at;
    for (Prediction& one : rows) one.error_N = error_N(one, by_m);
    squares += by_m * by_m;
  }
  const auto count = static_cast<double>(units.size());
  return std::sqrt(squares * (count * count - 1.0) / std::pow(count, 3));
}

}  // namespace

std::vector<Eigen::Index> ResidualRows::outside(int without) const {
  std::vector<Eigen::Index> others;
  for (std::size_t i = 0; i < fold.size(); ++i)
    if (fold[i] != without) others.push_back(static_cast<Eigen::Index>(i));
  return others;
}

Eigen::VectorXd ResidualRows::residual_N(int without) const {
  Eigen::VectorXd residual_N = force_N - trend_N.col(without);
  for (Eigen::Index i = 0; i < residual_N.size(); ++i)
    if (no_force[static_cast<std::size_t>(i)]) residual_N(i) = std::min(0.0, residual_N(i));
  return residual_N;
}

double ResidualRows::predicted_N(const ModelData& common, std::size_t i, double inner_radius, double h) const {
  const double outer_to_inner = common.cover.outer_radius / common.cover.inner_radius;
  const double trust = trust_at_distance(distance[i], inner_radius, outer_to_inner * inner_radius);
  const double limit_N = common.correction_limit_N;
  const double trend = trend_N(static_cast<Eigen::Index>(i), fold[i]);
  return std::max(common.lowest_force_N, trend + trust * std::clamp(h, -limit_N, limit_N));
}

Sites ResidualRows::sites_without(int without, double smoothing) const {
  const std::vector<Eigen::Index> others = outside(without);
  return even_subset({points(Eigen::all, others), residual_N(without)(others), row_scale(others), kernel, smoothing},
                     1000);  // with 1500 the coverage of the bound differs by at most 0.6 points
}

void ResidualRows::find_distances() {
  distance.assign(fold.size(), std::numeric_limits<double>::infinity());
  parallel_for(folds(), [&](int mine) {
    const std::vector<Eigen::Index> others = outside(mine);
    if (others.empty()) return;
    const NearestDistance nearest(points(Eigen::all, others));
    for (std::size_t i = 0; i < fold.size(); ++i) {
      if (fold[i] != mine) continue;
      const Eigen::VectorXd point = points.col(static_cast<Eigen::Index>(i));
      distance[i] = std::sqrt(nearest.squared(point.data()));
    }
  });
}

ResidualRows residual_rows(const ModelData& common, const TrendColumns& columns, const Eigen::MatrixXd& features,
                           const Eigen::MatrixXd& left_out_trends) {
  const double no_force_N = columns.samples().no_force_N();
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < columns.count(); i += columns.count() / 2500 + 1) order.push_back(i);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return columns.fold(i); });
  const auto n = static_cast<Eigen::Index>(order.size());
  ResidualRows out;
  out.points.resize(features.rows(), n);
  for (Eigen::VectorXd* values : {&out.force_N, &out.depth_m, &out.row_scale, &out.speed_m_per_s, &out.moved_N})
    values->resize(n);
  out.trend_N.resize(n, left_out_trends.cols());
  for (Eigen::Index k = 0; k < n; ++k) {
    const std::size_t row = order[static_cast<std::size_t>(k)];
    const auto in_contact = static_cast<Eigen::Index>(row * columns.stride());
    out.points.col(k) = (features.col(in_contact) - common.offset).cwiseQuotient(common.scale);
    out.force_N(k) = columns.force_N(row);
    out.depth_m(k) = columns.depth_m(row);
    out.row_scale(k) = 1.0 / common.jnd.at(out.force_N(k));
    out.trend_N.row(k) = columns.terms().row(static_cast<Eigen::Index>(row)) * left_out_trends;
    out.fold.push_back(columns.fold(row));
    out.unit.push_back(columns.unit(row));
    const std::size_t sample = columns.rows()[row];
    out.speed_m_per_s(k) = std::abs(columns.samples().rows[sample].motion.velocity_m_per_s);
    const RecordingOffset& offset =
        columns.samples().offsets[static_cast<std::size_t>(columns.samples().recording[sample])];
    out.moved_N(k) = common.trend.moved_N(out.depth_m(k), offset.offset_m) - offset.force_zero_N;
    out.no_force.push_back(std::abs(out.force_N(k)) <= no_force_N ? 1 : 0);
  }
  out.find_distances();
  return out;
}

std::vector<Prediction> predictions_of(const ResidualRows& rows, const ModelData& common,
                                       const std::vector<CorrectionPtr>& corrections) {
  const double inner_radius = common.cover.inner_radius;
  std::vector<Prediction> predictions;
  for (std::size_t i = 0; i < rows.fold.size(); ++i) {
    if (!std::isfinite(rows.distance[i])) continue;  // there is no other fold
    const auto row = static_cast<Eigen::Index>(i);
    double correction_N = 0.0;
    if (!corrections.empty()) {
      const Eigen::VectorXd point = rows.points.col(row);
      correction_N = corrections[static_cast<std::size_t>(rows.fold[i])]->evaluate(point.data());
    }
    const double force_N = rows.predicted_N(common, i, inner_radius, correction_N);
    predictions.push_back({force_N + rows.moved_N(row) - rows.force_N(row), force_N,
                           std::max(0.0, rows.distance[i] - inner_radius), rows.unit[i], rows.depth_m(row),
                           rows.speed_m_per_s(row)});
  }
  return predictions;
}

std::optional<ErrorBound> fit_bound(const std::vector<Prediction>& predictions, const ModelData& common) {
  std::map<int, std::vector<Prediction>> units;
  for (const Prediction& one : predictions) units[one.unit].push_back(one);
  if (predictions.size() < 50 || units.size() < 2) return std::nullopt;
  const double surface_error_m = register_surfaces(units, common);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(3, 3);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(3);
  for (const auto& [unit, rows] : units)
    for (const Prediction& one : rows) {
      const double scale = 1.0 / common.jnd.at(one.predicted_N);
      const Eigen::Vector3d row = scale * Eigen::Vector3d(1.0, std::abs(one.predicted_N), one.beyond);
      gram += row * row.transpose();
      right += row * scale * std::abs(one.error_N);
    }
  const Eigen::VectorXd shape = solve_non_negative(gram, right);
  // One unit of distance beyond the data nothing is known but the range of the force: the mean error of a prediction in
  // its middle is a quarter of it, and the largest error of any prediction all of it.
  const double least_per_distance_N = 0.25 * common.largest_force_N;
  // Above 0, so that the factor enlarges it.
  ErrorBound bound{std::max(shape(0), 1e-3), shape(1), std::max(shape(2), least_per_distance_N), surface_error_m};
  std::vector<double> factors;
  for (auto& [unit, rows] : units) factors.push_back(factor_of(std::move(rows), bound));
  const double factor = nth_smallest(factors, conformal_rank(factors.size(), 0.9));
  bound.floor_N = std::max(factor * bound.floor_N, kForceFloor_N);
  bound.per_force *= factor;
  bound.per_distance_N = std::clamp(factor * bound.per_distance_N, least_per_distance_N,
                                    std::max(least_per_distance_N, common.largest_force_N));
  return bound;
}

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
      candidate.errors.add(fold, common.jnd.error_over_jnd(force_N, rows.force_N(row)));
    }
  };
  std::vector<ScoredCorrection> candidates{{{false, fits.unit(), least_radius}, folds}};  // no correction
  for (int decade = kHighestDecade; decade >= kLowestDecade; --decade)
    for (const double factor : kRadiusFactors)
      candidates.push_back({{true, fits.unit() * std::pow(10.0, decade), factor * least_radius}, folds});
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
