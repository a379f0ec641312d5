#include "models/surface/common_trend.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "models/surface/surface_numbers.h"
#include "models/training/fit_trend.h"

namespace palpate {
namespace {

constexpr std::size_t kPiecesOfARecording = 16;
constexpr int kActivePasses = 3;
constexpr double kDerivativeStep_m = 10e-6;
constexpr double kTrendHuberLimit = 2.0;  // JND

}  // namespace

CommonTrend::CommonTrend(const std::vector<RegisteredMember>& members, const std::vector<FeatureSpec>& features,
                         double force_noise_floor_N, const std::vector<double>& start_m)
    : members_(members), force_noise_floor_N_(force_noise_floor_N) {
  bool viscous = false;
  for (const FeatureSpec& spec : features) {
    viscous = viscous || spec.kind == FeatureKind::velocity;
    if (spec.kind == FeatureKind::lowpass_velocity) times_s_.push_back(spec.relaxation_time_s);
  }
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t r = 0; r < members.size(); ++r) {
    for (const SurfaceRow& row : members[r].rows) {
      const double depth_m = row.motion.position_m - start_m[r];
      if (!(depth_m > 0.0)) continue;
      depth_m_ = std::max(depth_m_, depth_m);
      squares += row.motion.velocity_m_per_s * row.motion.velocity_m_per_s;
      count += 1.0;
    }
  }
  velocity_m_per_s_ = viscous ? std::max(1e-6, std::sqrt(squares / std::max(count, 1.0))) : 0.0;
}

double CommonTrend::fit(const std::vector<double>& offsets_m) {
  at_.clear();
  stepped_.clear();
  air_cost_ = 0.0;
  for (std::size_t r = 0; r < members_.size(); ++r) {
    at_.push_back(rows_of(r, offsets_m[r], 0.0, &air_cost_));
    stepped_.push_back(rows_of(r, offsets_m[r], kDerivativeStep_m, nullptr));
  }
  begin_weights();
  for (int pass = 0; pass < kActivePasses; ++pass) {
    const Sums sums = trend_sums();
    x_ = solve_non_negative(sums.gram, sums.right_side);
    if (!update_weights()) break;
  }
  return cost();
}

std::vector<double> CommonTrend::step(std::size_t without) const {
  const auto n = static_cast<Eigen::Index>(at_.front().columns());
  const auto m = static_cast<Eigen::Index>(members_.size());
  Sums sums(n + m);
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    if (fold == without) continue;
    sums.gram += folds_[fold].gram;
    sums.right_side += folds_[fold].right_side;
  }
  // A stiff spring on the sum keeps it at zero.
  Eigen::MatrixXd offsets = sums.gram.bottomRightCorner(m, m);
  const double stiff = std::max(1e-12, offsets.diagonal().maxCoeff());
  offsets.diagonal().array() += 1e-9 * stiff;
  offsets.array() += 1e3 * stiff;
  const Eigen::LLT<Eigen::MatrixXd> solver(offsets);
  const Eigen::MatrixXd coupling = sums.gram.topRightCorner(n, m);
  const Eigen::VectorXd force = sums.right_side.tail(m);
  const Eigen::MatrixXd gram = sums.gram.topLeftCorner(n, n) - coupling * solver.solve(coupling.transpose());
  const Eigen::VectorXd right_side = sums.right_side.head(n) - coupling * solver.solve(force);
  const Eigen::VectorXd x = solve_non_negative(gram, right_side);
  const Eigen::VectorXd step = solver.solve(force - coupling.transpose() * x);
  return {step.data(), step.data() + m};
}

double CommonTrend::misfit_m(std::size_t r) const {
  const auto at = static_cast<Eigen::Index>(at_.front().columns() + r);
  double slopes = 0.0;
  for (const Sums& fold : folds_) slopes += fold.gram(at, at);
  double squares = 0.0;
  for (std::size_t i = 0; i < at_[r].count(); ++i) {
    const double error = scale_[r][i] * (at_[r].force_N(i) - predicted_N(at_[r], i));
    squares += error * error;
  }
  return slopes > 0.0 ? std::sqrt(squares / slopes) : kUnknownError;
}

void CommonTrend::gather() {
  const auto n = static_cast<Eigen::Index>(at_.front().columns());
  const auto m = static_cast<Eigen::Index>(members_.size());
  folds_.assign(kFolds, Sums(n + m));
  Eigen::VectorXd column(n + 1);
  for (std::size_t r = 0; r < at_.size(); ++r) {
    const TrendRows& rows = at_[r];
    const auto offset = n + static_cast<Eigen::Index>(r);
    const std::size_t piece = rows.count() / kPiecesOfARecording + 1;
    for (std::size_t i = 0; i < rows.count(); ++i) {
      const double scale = scale_[r][i];
      if (scale == 0.0) continue;
      Sums& fold = folds_[(i / piece) % kFolds];
      const double slope = (predicted_N(stepped_[r], i) - predicted_N(rows, i)) / kDerivativeStep_m;
      column.head(n) = scale * Eigen::Map<const Eigen::VectorXd>(rows.row(i), n);
      column(n) = scale * slope;
      const double force = scale * rows.force_N(i);
      fold.gram.topLeftCorner(n, n).noalias() += column.head(n) * column.head(n).transpose();
      fold.gram.col(offset).head(n) += column(n) * column.head(n);
      fold.gram(offset, offset) += column(n) * column(n);
      fold.right_side.head(n) += force * column.head(n);
      fold.right_side(offset) += force * column(n);
    }
  }
  for (Sums& fold : folds_) fold.gram.bottomLeftCorner(m, n) = fold.gram.topRightCorner(n, m).transpose();
}

TrendRows CommonTrend::rows_of(std::size_t r, double offset_m, double step_m, double* air_cost) const {
  TrendRows rows(depth_m_, velocity_m_per_s_, times_s_);
  rows.begin_recording();
  for (const SurfaceRow& row : members_[r].rows) {
    ToolSample sample = row.sample;
    MotionEstimate motion = row.motion;
    sample.position_m -= offset_m;
    motion.position_m -= offset_m + step_m;
    rows.add(sample, motion, row.force_N, 0);
    if (air_cost == nullptr || sample.position_m > 0.0) continue;
    *air_cost += huber(row.force_N / jnd_.at(row.force_N), kTrendHuberLimit);
  }
  return rows;
}

double CommonTrend::predicted_N(const TrendRows& rows, std::size_t i) const {
  return Eigen::Map<const Eigen::VectorXd>(rows.row(i), x_.size()).dot(x_);
}

void CommonTrend::begin_weights() {
  scale_.clear();
  for (const TrendRows& rows : at_) {
    scale_.emplace_back(rows.count());
    for (std::size_t i = 0; i < rows.count(); ++i) scale_.back()[i] = 1.0 / jnd_.at(rows.force_N(i));
  }
}

// Contact is one-sided, large errors count less. Returns whether a row changed sides.
bool CommonTrend::update_weights() {
  bool changed = false;
  for (std::size_t r = 0; r < at_.size(); ++r) {
    for (std::size_t i = 0; i < at_[r].count(); ++i) {
      const double force_N = at_[r].force_N(i);
      const double model_N = predicted_N(at_[r], i);
      const bool idle = force_N <= force_noise_floor_N_ && !(model_N > 0.0);
      const double ratio = std::abs(force_N - model_N) / jnd_.at(force_N);
      const double counts = std::min(1.0, kTrendHuberLimit / std::max(ratio, 1e-12));
      const double scale = idle ? 0.0 : std::sqrt(counts) / jnd_.at(force_N);
      changed = changed || (scale == 0.0) != (scale_[r][i] == 0.0) || ratio > kTrendHuberLimit;
      scale_[r][i] = scale;
    }
  }
  return changed;
}

CommonTrend::Sums CommonTrend::trend_sums() const {
  const auto n = static_cast<Eigen::Index>(at_.front().columns());
  Sums sums(n);
  for (std::size_t r = 0; r < at_.size(); ++r) {
    for (std::size_t i = 0; i < at_[r].count(); ++i) {
      const double scale = scale_[r][i];
      if (scale == 0.0) continue;
      const Eigen::Map<const Eigen::VectorXd> row(at_[r].row(i), n);
      sums.gram.selfadjointView<Eigen::Lower>().rankUpdate(row, scale * scale);
      sums.right_side += scale * scale * at_[r].force_N(i) * row;
    }
  }
  sums.gram.triangularView<Eigen::StrictlyUpper>() = sums.gram.transpose();
  return sums;
}

double CommonTrend::cost() const {
  double sum = air_cost_;
  for (const TrendRows& rows : at_) {
    for (std::size_t i = 0; i < rows.count(); ++i) {
      const double error_N = rows.force_N(i) - std::max(0.0, predicted_N(rows, i));
      sum += huber(error_N / jnd_.at(rows.force_N(i)), kTrendHuberLimit);
    }
  }
  return sum;
}

}  // namespace palpate
