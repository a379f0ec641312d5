#include "models/training/cross_validated_trend.h"

#include <algorithm>
#include <cmath>

#include "models/training/fit_trend.h"

namespace palpate {
namespace {

constexpr int kPasses = 3;
constexpr Eigen::Index kBlock = 256;

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
    double& deepest = deepest_m[static_cast<std::size_t>(rows.stroke(i))];
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

double CrossValidation::mean() const {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t k = 0; k < fold_error.size(); ++k) {
    sum += fold_count[k] * fold_error[k];
    count += fold_count[k];
  }
  return count > 0.0 ? sum / count : 0.0;
}

double CrossValidation::standard_error_against(const CrossValidation& other) const {
  double total = 0.0;
  for (const double count : fold_count) total += count;
  const auto folds = static_cast<double>(fold_error.size());
  if (folds < 2.0 || !(total > 0.0)) return 0.0;
  // Every fold's share of the mean difference.
  std::vector<double> share;
  double mean_share = 0.0;
  for (std::size_t k = 0; k < fold_error.size(); ++k) {
    share.push_back((fold_error[k] - other.fold_error[k]) * fold_count[k] / total * folds);
    mean_share += share.back() / folds;
  }
  double squares = 0.0;
  for (const double value : share) squares += (value - mean_share) * (value - mean_share);
  return std::sqrt(squares / (folds * (folds - 1.0)));
}

double CrossValidatedTrend::Equations::residual(const Eigen::VectorXd& x) const {
  return std::max(0.0, squares - 2.0 * right_side.dot(x) + x.dot(gram * x));
}

CrossValidatedTrend::CrossValidatedTrend(const TrendRows& rows, int folds, Weighting weighting, const JndLine& jnd,
                                         double force_noise_floor_N)
    : train_(static_cast<std::size_t>(folds)), validation_(train_.size()) {
  std::vector<double> scale(rows.count());
  for (std::size_t i = 0; i < rows.count(); ++i) scale[i] = row_scale(weighting, jnd, rows.force_N(i));
  std::vector<char> active(rows.count(), 1);
  const std::vector<double> elsewhere_m = deepest_elsewhere(rows, folds);
  accumulate(rows, scale, active, elsewhere_m);
  for (int pass = 0; pass < kPasses; ++pass) {
    // All columns together tell well enough where the tool outran the material, and
    // which samples no set of features will ever explain.
    const Eigen::VectorXd x = solve_non_negative(total_.gram, total_.right_side);
    bool changed = false;
    for (std::size_t i = 0; i < rows.count(); ++i) {
      const double trend_N = Eigen::Map<const Eigen::VectorXd>(rows.row(i), x.size()).dot(x);
      const double plain = row_scale(weighting, jnd, rows.force_N(i));
      const double robust = plain * robust_scale(jnd.error_over_jnd(trend_N, rows.force_N(i)));
      changed = changed || std::abs(robust - scale[i]) > 0.1 * plain;
      scale[i] = robust;
      if (rows.force_N(i) > force_noise_floor_N) continue;
      const char counts = trend_N > 0.0 ? 1 : 0;
      changed = changed || counts != active[i];
      active[i] = counts;
    }
    if (!changed) break;
    accumulate(rows, scale, active, elsewhere_m);
  }
}

void CrossValidatedTrend::accumulate(const TrendRows& rows, const std::vector<double>& scale,
                                     const std::vector<char>& active, const std::vector<double>& elsewhere_m) {
  const auto n = static_cast<Eigen::Index>(rows.columns());
  total_ = {Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0.0, 0.0};
  for (std::size_t k = 0; k < train_.size(); ++k) {
    GramSum shallow(n);
    GramSum deep(n);
    for (std::size_t i = 0; i < rows.count(); ++i) {
      if (!active[i] || rows.stroke(i) != static_cast<int>(k)) continue;
      (rows.depth_m(i) <= elsewhere_m[k] ? shallow : deep).add(rows.row(i), rows.force_N(i), scale[i]);
    }
    const Eigen::MatrixXd& validation = shallow.finish();
    const Eigen::MatrixXd all = validation + deep.finish();
    validation_[k] = {validation.topLeftCorner(n, n), validation.col(n).head(n), validation(n, n), shallow.count()};
    train_[k] = {all.topLeftCorner(n, n), all.col(n).head(n), all(n, n), shallow.count() + deep.count()};
    rows.smooth_splines(train_[k].gram);
    total_.gram += train_[k].gram;
    total_.right_side += train_[k].right_side;
    total_.squares += train_[k].squares;
    total_.count += train_[k].count;
  }
}

CrossValidation CrossValidatedTrend::left_out(const ColumnList& columns, const CrossValidation* near) const {
  CrossValidation result;
  for (std::size_t k = 0; k < train_.size(); ++k) {
    const Eigen::MatrixXd gram = total_.gram(columns, columns) - train_[k].gram(columns, columns);
    const Eigen::VectorXd right_side = total_.right_side(columns) - train_[k].right_side(columns);
    const Eigen::VectorXd start = near != nullptr ? Eigen::VectorXd(near->solutions[k](columns)) : Eigen::VectorXd();
    Eigen::VectorXd x = Eigen::VectorXd::Zero(total_.gram.cols());
    x(columns) = solve_non_negative(gram, right_side, start);
    result.fold_error.push_back(validation_[k].count > 0.0 ? validation_[k].residual(x) / validation_[k].count : 0.0);
    result.fold_count.push_back(validation_[k].count);
    result.solutions.push_back(std::move(x));
  }
  return result;
}

Eigen::VectorXd CrossValidatedTrend::solve(const ColumnList& columns) const {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(total_.gram.cols());
  x(columns) = solve_non_negative(total_.gram(columns, columns), total_.right_side(columns));
  return x;
}

double CrossValidatedTrend::training_error(const Eigen::VectorXd& solution) const {
  return total_.count > 0.0 ? total_.residual(solution) / total_.count : 0.0;
}

}  // namespace palpate
