#include "models/training/trend_regression.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "models/training/acceptance.h"

namespace palpate {
namespace {

// Relative to unit-norm columns: far below any information in a recording, far
// above rounding; decides only between columns that are equal.
constexpr double kEqualColumns = 1e-8;
// Which samples are on their side, and which no features explain, settles within so many.
constexpr int kPasses = 4;
constexpr Eigen::Index kBlock = 256;

// Lawson & Hanson's working state on unit-norm columns.
class NonNegativeSolver {
 public:
  NonNegativeSolver(Eigen::MatrixXd gram, Eigen::VectorXd right_side)
      : gram_(std::move(gram)),
        right_side_(std::move(right_side)),
        x_(Eigen::VectorXd::Zero(right_side_.size())),
        passive_(static_cast<std::size_t>(right_side_.size()), 0) {}

  void start_at(const Eigen::VectorXd& x) {
    x_ = x;
    for (Eigen::Index i = 0; i < x_.size(); ++i) passive_[static_cast<std::size_t>(i)] = x_(i) > 0.0 ? 1 : 0;
    move_to_minimum();
  }

  Eigen::VectorXd solve() {
    // They end after few changes; 3 n is their own bound.
    for (Eigen::Index change = 0; change < 3 * x_.size(); ++change) {
      const Eigen::Index entering = most_promising();
      if (entering < 0) break;
      passive_[static_cast<std::size_t>(entering)] = 1;
      move_to_minimum();
    }
    return x_;
  }

 private:
  bool passive(Eigen::Index i) const { return passive_[static_cast<std::size_t>(i)] != 0; }

  Eigen::Index most_promising() const {
    const Eigen::VectorXd gradient = right_side_ - gram_ * x_;
    const double tolerance = 1e-12 * std::max(1e-300, right_side_.cwiseAbs().maxCoeff());
    Eigen::Index best = -1;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      if (passive(i) || gradient(i) <= tolerance) continue;
      if (best < 0 || gradient(i) > gradient(best)) best = i;
    }
    return best;
  }

  Eigen::VectorXd unconstrained() const {
    std::vector<Eigen::Index> index;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      if (passive(i)) index.push_back(i);
    }
    Eigen::VectorXd full = Eigen::VectorXd::Zero(x_.size());
    if (index.empty()) return full;
    const Eigen::MatrixXd part = gram_(index, index);
    const Eigen::VectorXd part_right_side = right_side_(index);
    const Eigen::VectorXd solution = part.llt().solve(part_right_side);
    full(index) = solution;
    return full;
  }

  // Walks towards the minimum over the passive set; a coefficient that would
  // turn negative stops the walk and leaves the set.
  void move_to_minimum() {
    Eigen::VectorXd candidate = unconstrained();
    for (Eigen::Index leaving = 0; leaving < x_.size(); ++leaving) {
      double step = 1.0;
      Eigen::Index blocking = -1;
      for (Eigen::Index i = 0; i < x_.size(); ++i) {
        if (!passive(i) || candidate(i) > 0.0) continue;
        const double reach = x_(i) / std::max(x_(i) - candidate(i), 1e-300);
        if (blocking < 0 || reach < step) {
          step = std::min(1.0, reach);
          blocking = i;
        }
      }
      if (blocking < 0) break;
      x_ += step * (candidate - x_);
      x_(blocking) = 0.0;
      passive_[static_cast<std::size_t>(blocking)] = 0;
      candidate = unconstrained();
    }
    x_ = candidate;
  }

  Eigen::MatrixXd gram_;
  Eigen::VectorXd right_side_;
  Eigen::VectorXd x_;
  std::vector<char> passive_;
};

// Adds blocks of scaled rows to a Gram matrix.
class GramSum {
 public:
  explicit GramSum(Eigen::Index n) : block_(n + 1, kBlock), sum_(Eigen::MatrixXd::Zero(n + 1, n + 1)) {}

  void add(const double* row, double force_N, double scale) {
    const Eigen::Index n = block_.rows() - 1;
    block_.col(filled_).head(n) = scale * Eigen::Map<const Eigen::VectorXd>(row, n);
    block_(n, filled_) = scale * force_N;
    count_ += 1.0;
    if (++filled_ == kBlock) flush();
  }

  // The sums; the last row and column are those of the force.
  const Eigen::MatrixXd& finish() {
    flush();
    sum_.triangularView<Eigen::StrictlyUpper>() = sum_.transpose();
    return sum_;
  }
  double count() const { return count_; }

 private:
  void flush() {
    if (filled_ == 0) return;
    sum_.selfadjointView<Eigen::Lower>().rankUpdate(block_.leftCols(filled_));
    filled_ = 0;
  }

  Eigen::MatrixXd block_;
  Eigen::MatrixXd sum_;
  Eigen::Index filled_ = 0;
  double count_ = 0.0;
};

std::vector<double> deepest_elsewhere(const TrendRows& rows, int folds) {
  std::vector<double> deepest_m(static_cast<std::size_t>(folds), 0.0);
  for (std::size_t i = 0; i < rows.count(); ++i) {
    double& deepest = deepest_m[static_cast<std::size_t>(rows.fold(i))];
    deepest = std::max(deepest, rows.depth_m(i));
  }
  std::vector<double> elsewhere_m(deepest_m.size(), 0.0);
  for (std::size_t k = 0; k < deepest_m.size(); ++k) {
    for (std::size_t other = 0; other < deepest_m.size(); ++other) {
      if (other != k) elsewhere_m[k] = std::max(elsewhere_m[k], deepest_m[other]);
    }
  }
  return elsewhere_m;
}

}  // namespace

Eigen::VectorXd solve_non_negative(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right_side,
                                   const Eigen::VectorXd& start) {
  Eigen::VectorXd inverse_norm = gram.diagonal();
  for (double& value : inverse_norm) value = value > 0.0 ? 1.0 / std::sqrt(value) : 0.0;
  Eigen::MatrixXd scaled = inverse_norm.asDiagonal() * gram * inverse_norm.asDiagonal();
  scaled.diagonal().array() += kEqualColumns;
  NonNegativeSolver solver(std::move(scaled), right_side.cwiseProduct(inverse_norm));
  if (start.size() > 0 && (start.array() > 0.0).any()) {
    const auto moving = inverse_norm.array() > 0.0;
    solver.start_at(moving.select(start.array() / moving.select(inverse_norm.array(), 1.0), 0.0).matrix());
  }
  return solver.solve().cwiseMax(0.0).cwiseProduct(inverse_norm);
}

double LeftOutTrend::rms() const {
  const double sum = std::accumulate(fold_error.begin(), fold_error.end(), 0.0);
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

double TrendRegression::Equations::residual(const Eigen::VectorXd& x) const {
  return std::max(0.0, squares - 2.0 * right_side.dot(x) + x.dot(gram * x));
}

TrendRegression::TrendRegression(const TrendRows& rows, int folds, Weighting weighting, const JndLine& jnd,
                                 double force_noise_floor_N)
    : scale_(rows.count()),
      train_(static_cast<std::size_t>(folds)),
      validation_(train_.size()),
      own_error_(rows.terms().creep_times_s.empty() ? kOwnErrorOfFew : kOwnError) {
  for (std::size_t i = 0; i < rows.count(); ++i) scale_[i] = palpate::row_scale(weighting, jnd, rows.force_N(i));
  const std::vector<double> elsewhere_m = deepest_elsewhere(rows, folds);
  gather(rows, elsewhere_m);
  for (int pass = 0; pass < kPasses; ++pass) {
    // All columns together tell well enough where the tool outran the material, and
    // which samples no set of features will ever explain.
    const Eigen::VectorXd x = solve(all_columns());
    bool changed = false;
    for (std::size_t i = 0; i < rows.count(); ++i) {
      const double trend_N = Eigen::Map<const Eigen::VectorXd>(rows.row(i), x.size()).dot(x);
      const double plain = palpate::row_scale(weighting, jnd, rows.force_N(i));
      double scale = plain * robust_scale(jnd.error_over_jnd(trend_N, rows.force_N(i)));
      if (std::abs(rows.force_N(i)) <= force_noise_floor_N && trend_N <= 0.0) scale = 0.0;
      changed = changed || std::abs(scale - scale_[i]) > 0.1 * plain;
      scale_[i] = scale;
    }
    if (!changed) break;
    gather(rows, elsewhere_m);
  }
  LeftOutTrend best = left_out(all_columns(), smoothness_, nullptr);
  std::vector<LeftOutTrend> of_each;
  for (const double smoothness : kSmoothness) {
    of_each.push_back(left_out(all_columns(), smoothness, &best));
    if (of_each.back().rms() < best.rms()) best = of_each.back();
  }
  for (std::size_t i = 0; i < kSmoothness.size(); ++i) {
    smoothness_ = kSmoothness[i];
    if (!is_worth_it(best.fold_error, of_each[i].fold_error)) break;
  }
}

void TrendRegression::gather(const TrendRows& rows, const std::vector<double>& elsewhere_m) {
  const auto n = static_cast<Eigen::Index>(rows.columns());
  total_ = {Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0.0, 0.0};
  for (std::size_t k = 0; k < train_.size(); ++k) {
    GramSum shallow(n);
    GramSum deep(n);
    for (std::size_t i = 0; i < rows.count(); ++i) {
      if (scale_[i] == 0.0 || rows.fold(i) != static_cast<int>(k)) continue;
      (rows.depth_m(i) <= elsewhere_m[k] ? shallow : deep).add(rows.row(i), rows.force_N(i), scale_[i]);
    }
    const Eigen::MatrixXd& validation = shallow.finish();
    const Eigen::MatrixXd all = validation + deep.finish();
    validation_[k] = {validation.topLeftCorner(n, n), validation.col(n).head(n), validation(n, n), shallow.count()};
    train_[k] = {all.topLeftCorner(n, n), all.col(n).head(n), all(n, n), shallow.count() + deep.count()};
    total_.gram += train_[k].gram;
    total_.right_side += train_[k].right_side;
    total_.squares += train_[k].squares;
    total_.count += train_[k].count;
  }
}

ColumnList TrendRegression::all_columns() const {
  ColumnList all(static_cast<std::size_t>(total_.gram.cols()));
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  return all;
}

// The penalised solution on these columns, over all of them. The elastic response's come first.
Eigen::VectorXd TrendRegression::weights(Eigen::MatrixXd gram, const Eigen::VectorXd& right_side,
                                         const ColumnList& columns, double smoothness,
                                         const Eigen::VectorXd& start) const {
  constexpr auto kElastic = static_cast<Eigen::Index>(kSplineTerms);
  const double smooth = smoothness * gram.diagonal().head(kElastic).mean();
  gram.diagonal().tail(gram.cols() - kElastic) *= 1.0 + own_error_ * own_error_;
  for (Eigen::Index k = 0; k + 1 < kElastic; ++k) {
    gram(k, k) += smooth;
    gram(k + 1, k + 1) += smooth;
    gram(k, k + 1) -= smooth;
    gram(k + 1, k) -= smooth;
  }
  Eigen::VectorXd x = Eigen::VectorXd::Zero(gram.cols());
  const Eigen::VectorXd some_start = start.size() > 0 ? Eigen::VectorXd(start(columns)) : start;
  x(columns) = solve_non_negative(gram(columns, columns), right_side(columns), some_start);
  return x;
}

LeftOutTrend TrendRegression::left_out(const ColumnList& columns, double smoothness, const LeftOutTrend* near) const {
  LeftOutTrend result;
  result.solutions.resize(total_.gram.cols(), static_cast<Eigen::Index>(train_.size()));
  for (std::size_t k = 0; k < train_.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    const Eigen::VectorXd start = near != nullptr ? Eigen::VectorXd(near->solutions.col(column)) : Eigen::VectorXd();
    result.solutions.col(column) =
        weights(total_.gram - train_[k].gram, total_.right_side - train_[k].right_side, columns, smoothness, start);
    result.fold_error.push_back(validation_[k].residual(result.solutions.col(column)));
    result.count += validation_[k].count;
  }
  return result;
}

LeftOutTrend TrendRegression::left_out(const ColumnList& columns, const LeftOutTrend* near) const {
  return left_out(columns, smoothness_, near);
}

Eigen::VectorXd TrendRegression::solve(const ColumnList& columns) const {
  return weights(total_.gram, total_.right_side, columns, smoothness_, {});
}

}  // namespace palpate
