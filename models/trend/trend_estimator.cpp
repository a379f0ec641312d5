#include "models/trend/trend_estimator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "engine/base/parallel.h"
#include "models/linear/lapack.h"

namespace palpate {
namespace {

// Active set and robust weights converge within these passes.
constexpr int kPasses = 4;
// A robust factor that changes by less stays as it is: the fit takes 0.7 of the time, and the mean share of the recorded
// rigs is within 0.15 points (tests/labs.py).
constexpr double kSameScale = 0.01;
// The candidates for lambda: 1e-6 smooths over a third of the depth, 1e-9 over two pieces.
constexpr std::array kSmoothness{1e-6, 1e-7, 1e-8, 1e-9};

// The trends of some solutions at the rows: rows x solutions.
Eigen::MatrixXd values_of(const TrendColumns& columns, const Eigen::MatrixXd& solutions) {
  Eigen::MatrixXd values(static_cast<Eigen::Index>(columns.count()), solutions.cols());
  // The matrix is stored by rows, which is its transpose stored by columns.
  const Eigen::Map<const Eigen::MatrixXd> transposed(columns.terms().data(), columns.columns(), values.rows());
  multiply(transposed, true, solutions, false, 1.0, 0.0, values);
  return values;
}

// At the greatest depth a relaxation time is exp(slowing) times that at the surface: 0.2 to 20. Simplest first.
constexpr std::array kSlowings{0.0, 0.75, -0.75, 1.5, -1.5, 2.25, 3.0};

// At most `most` of the values, evenly spaced by index.
std::vector<double> evenly(const std::vector<double>& values, std::size_t most) {
  if (values.size() <= most) return values;
  std::vector<double> few;
  for (std::size_t i = 0; i < most; ++i) few.push_back(values[i * (values.size() - 1) / (most - 1)]);
  return few;
}

// The list with fewer terms, for comparisons of many regressions.
FeatureList shortened(const FeatureList& list) {
  FeatureList few;
  few.add(FeatureKind::maxwell_spectrum, evenly(relaxation_times_s(list.features), 8));
  for (const FeatureSpec& spec : list.features) {
    if (spec.kind == FeatureKind::velocity) few.add(spec.kind);
    if (is_bristle(spec.kind)) few.add(spec.kind, evenly(constants_of(spec), 2));
  }
  return few;
}

FeatureList with_slowing(FeatureList list, double slowing) {
  for (FeatureSpec& spec : list.features)
    if (is_branch(spec.kind)) spec.slowing = slowing;
  return list;
}

}  // namespace

TrendEstimator::TrendEstimator(const TrendColumns& columns, const JndLine& jnd, double smoothness)
    : columns_(columns),
      jnd_(jnd),
      part_error_(has_kind(columns.list().features, FeatureKind::creep) ? kPartError : kPartErrorOfFew),
      smoothness_(smoothness),
      equations_(static_cast<std::size_t>(columns.folds()) + (smoothness > 0.0 ? 0 : 1)) {
  std::vector<int> fold;
  std::vector<double> depth_m;
  for (std::size_t i = 0; i < columns.count(); ++i) {
    fold.push_back(columns.fold(i));
    depth_m.push_back(columns.depth_m(i));
  }
  const int folds = columns.folds();
  deepest_elsewhere_m_ = deepest_elsewhere_m(fold, depth_m, folds);
  const BlasThreads one_thread(1);
  parallel_for(static_cast<int>(equations_.size()), [&](int k) { equations_[static_cast<std::size_t>(k)] = gather(k); });
  if (smoothness > 0.0) return;
  std::vector<FoldErrors> errors(kSmoothness.size());
  parallel_for(static_cast<int>(kSmoothness.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    errors[at] = cross_validate(all_columns(), kSmoothness[at]).errors;
  });
  smoothness_ = kSmoothness[simplest_adequate(errors)];
}

Eigen::VectorXd TrendEstimator::fit(const ColumnList& columns) const {
  const bool known = equations_.size() > static_cast<std::size_t>(columns_.folds());
  return solve(known ? equations_.back() : gather(columns_.folds()), columns, smoothness_);
}

// Iterates weights and active set on the rows outside the fold `left_out`. After the first pass few weights change.
TrendEstimator::Equations TrendEstimator::gather(int left_out) const {
  const double no_force_N = columns_.samples().no_force_N();
  const Eigen::Index n = columns_.columns();
  Equations equations{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0.0, Eigen::VectorXd::Zero(n)};
  std::vector<double> plain(columns_.count()), squares(plain.size()), scale(plain.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    plain[i] = scale[i] = columns_.fold(i) == left_out ? 0.0 : 1.0 / jnd_.at(columns_.force_N(i));
    squares[i] = plain[i] * plain[i];
  }
  add(equations, squares);
  for (int pass = 0; pass < kPasses; ++pass) {
    equations.start = solve(equations, all_columns(), kFirstSmoothness);
    const Eigen::VectorXd trend_N = values_of(columns_, equations.start);
    bool changed = false;
    for (std::size_t i = 0; i < scale.size(); ++i) {
      const double force_N = trend_N(static_cast<Eigen::Index>(i));
      const bool idle = std::abs(columns_.force_N(i)) <= no_force_N && force_N <= 0.0;
      const double robust = robust_scale(jnd_.error_over_jnd(force_N, columns_.force_N(i)));
      const double now = idle ? 0.0 : plain[i] * robust;
      changed = changed || std::abs(now - scale[i]) > 0.1 * plain[i];
      squares[i] = 0.0;
      if (std::abs(now - scale[i]) <= kSameScale * plain[i]) continue;
      squares[i] = now * now - scale[i] * scale[i];
      scale[i] = now;
    }
    if (!changed) break;
    add(equations, squares);
  }
  return equations;
}

void TrendEstimator::add(Equations& equations, const std::vector<double>& squares) const {
  const Eigen::Index n = columns_.columns();
  Eigen::MatrixXd block(n, kBlockRows);  // one column a row of the regression
  Eigen::VectorXd force_N(kBlockRows);
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(n, n);
  for (const double sign : {1.0, -1.0}) {
    Eigen::Index filled = 0;
    const auto flush = [&] {
      gram_of_transpose(block.leftCols(filled), product);
      equations.gram += sign * product;
      multiply(block.leftCols(filled), false, force_N.head(filled), false, sign, 1.0, equations.right_side);
      filled = 0;
    };
    for (std::size_t i = 0; i < columns_.count(); ++i) {
      if (!(sign * squares[i] > 0.0)) continue;
      const double scale = std::sqrt(sign * squares[i]);
      block.col(filled) = scale * columns_.terms().row(static_cast<Eigen::Index>(i)).transpose();
      force_N(filled) = scale * columns_.force_N(i);
      equations.scale_squares += squares[i];
      if (++filled == kBlockRows) flush();
    }
    if (filled > 0) flush();
  }
  equations.gram.triangularView<Eigen::StrictlyUpper>() = equations.gram.transpose();
}

// The penalised solution on these columns, 0 in all others. The columns of the elastic response come first, its splines
// before its force at the surface.
Eigen::VectorXd TrendEstimator::solve(const Equations& equations, const ColumnList& columns, double smoothness) const {
  constexpr auto kElastic = static_cast<Eigen::Index>(kElasticTerms);
  Eigen::MatrixXd gram = equations.gram;
  const double smooth = smoothness * equations.scale_squares * static_cast<double>(kElasticPieces);
  const auto elastic = static_cast<Eigen::Index>(columns_.feature_columns().front().size());
  gram.diagonal().tail(gram.cols() - elastic) *= 1.0 + part_error_ * part_error_;
  for (Eigen::Index k = 0; k + 1 < kElastic; ++k) {
    gram(k, k) += smooth;
    gram(k + 1, k + 1) += smooth;
    gram(k, k + 1) -= smooth;
    gram(k + 1, k) -= smooth;
  }
  Eigen::VectorXd x = Eigen::VectorXd::Zero(gram.cols());
  x(columns) = solve_non_negative(gram(columns, columns), equations.right_side(columns), equations.start(columns));
  return x;
}

CrossValidated TrendEstimator::cross_validate(const ColumnList& columns, double smoothness) const {
  const int folds = columns_.folds();
  CrossValidated result{static_cast<std::size_t>(folds), Eigen::MatrixXd(columns_.terms().cols(), folds)};
  for (int k = 0; k < folds; ++k)
    result.solutions.col(k) = solve(equations_[static_cast<std::size_t>(k)], columns, smoothness);
  const bool one_sided = std::isfinite(columns_.samples().no_force_N());
  const Eigen::MatrixXd trend_N = values_of(columns_, result.solutions);
  for (std::size_t i = 0; i < columns_.count(); ++i) {
    const auto fold = static_cast<std::size_t>(columns_.fold(i));
    if (columns_.depth_m(i) > deepest_elsewhere_m_[fold]) continue;
    const double force_N = trend_N(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(fold));
    result.errors.add(fold, jnd_.error_over_jnd(one_sided ? std::max(0.0, force_N) : force_N, columns_.force_N(i)));
  }
  return result;
}

Result<FeatureList> select_slowing(const Samples& samples, const JndLine& jnd, const FeatureList& list,
                                   std::vector<PartGain>& gains, const FitControl& control) {
  if (!has_kind(list.features, FeatureKind::maxwell_spectrum)) return list;
  // The filters are exact for steps of any length, and a hand moves little in 4 ms.
  const Samples few = thinned(samples, 3.9e-3);
  std::vector<FoldErrors> errors;
  for (const double slowing : kSlowings) {
    const auto columns = TrendColumns::make(few, with_slowing(shortened(list), slowing), kSearchRows, control);
    if (!columns) return columns.error();
    const TrendEstimator estimator(*columns, jnd, TrendEstimator::kFirstSmoothness);
    errors.push_back(estimator.cross_validate(estimator.all_columns()).errors);
  }
  const std::size_t chosen = simplest_adequate(errors);
  const FoldErrors& slower =
      chosen != 0 ? errors[chosen]
                  : *std::ranges::min_element(errors.begin() + 1, errors.end(), {}, &FoldErrors::rms_at_mean_score);
  gains.push_back(
      {"depth-dependent relaxation", chosen != 0, slower.rms_at_mean_score(), errors[0].rms_at_mean_score()});
  return with_slowing(list, kSlowings[chosen]);
}

Result<std::vector<double>> identify_relaxation(const Samples& samples, const JndLine& jnd, bool velocity,
                                                std::size_t count, const FitControl& control) {
  const std::vector<double> candidates_s = dictionary_times_s(samples);
  if (candidates_s.empty()) {
    return Error{
        "the recordings are too short to identify a relaxation time; record for longer, or pass --features scene"};
  }
  const auto rows = TrendColumns::make(samples, single_times(velocity, candidates_s), kSearchRows, control);
  if (!rows) return rows.error();
  const TrendEstimator estimator(*rows, jnd, TrendEstimator::kFirstSmoothness);
  const auto candidates = static_cast<int>(candidates_s.size());
  const int first = static_cast<int>(rows->list().features.size()) - candidates;
  std::vector<int> best;  // indices of the candidates, ascending
  double least = 0.0;     // the RMS error with these
  const auto attempt = [&](std::vector<int> times) {
    std::ranges::sort(times);
    if (std::ranges::adjacent_find(times) != times.end() || times.front() < 0 || times.back() >= candidates) return;
    // Elastic response, viscosity and the branches with these times.
    const auto columns = rows->columns_of([&](std::size_t f) {
      const int time = static_cast<int>(f) - first;
      return time < 0 || std::ranges::binary_search(times, time);
    });
    const double error = estimator.cross_validate(columns).errors.rms();
    if (times.size() == best.size() && error >= least) return;
    best = std::move(times);
    least = error;
  };
  while (best.size() < std::min(count, candidates_s.size())) {
    if (!control.may_continue()) return interrupted();
    const std::vector<int> last = best;
    for (int added = 0; added < candidates; ++added) {
      std::vector<int> times = last;
      times.push_back(added);
      attempt(std::move(times));
    }
    for (bool moved = !last.empty(); moved;) {
      const std::vector<int> from = best;
      for (std::size_t i = 0; i < from.size(); ++i) {
        for (const int step : {-1, 1}) {
          std::vector<int> times = from;
          times[i] += step;
          attempt(std::move(times));
        }
      }
      moved = best != from;
    }
  }
  std::vector<double> times_s;
  for (const int time : best) times_s.push_back(candidates_s[static_cast<std::size_t>(time)]);
  return times_s;
}

}  // namespace palpate
