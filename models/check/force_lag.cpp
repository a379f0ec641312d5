// The lag of the force channel of a recording behind its position channel. The memory of a material makes the force
// lead the depth, never lag. A regression with non-negative weights,
//   F(t) ~ c + E(p) + sum_t b_t + eta(p) v,   p, v: position and velocity at t - lag, c: force zero,
// therefore has a larger residual where the force is late. A force that is early looks like viscosity, unless it begins
// before contact. E and the spring of each Maxwell branch b_t are rising splines over the positions, all 0 in air.
// Residuals are divided by the noise plus 3 % of the force, with a Huber loss beyond 3.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "engine/tick/sensor_identification.h"
#include "models/check/recording_measures.h"
#include "models/linear/lapack.h"

namespace palpate {
namespace {

constexpr double kNearLag_s = 0.05;  // searched in fine steps, and by every row
// The steps of the search for a longer lag, on every fourth row: a fifth of a quick stroke.
constexpr double kFarStep_s = 0.04;
constexpr std::size_t kFarStride = 4;
// A longer lag is searched for where it lowers the cost to this share.
constexpr double kFarGain = 0.5;
constexpr double kCoarse_s = 0.005;  // between lags, and at least between rows
constexpr double kFine_s = 0.2e-3;
// The required accuracy: a lag with two standard errors above it is not identified; lags that differ by at most this
// agree. Rows that are more than ten times this apart identify no lag.
constexpr double kAccuracy_s = 0.002;
constexpr int kElastic = 24;
constexpr int kBranch = 6;
constexpr int kViscous = 6;
constexpr std::array kTimes_s{0.03, 0.3, 3.0};
constexpr int kFirstBranch = 2 + kElastic;  // after the constants
constexpr int kFirstViscous = kFirstBranch + kBranch * static_cast<int>(kTimes_s.size());
constexpr int kColumns = kFirstViscous + kViscous;
constexpr double kForceShare = 0.03;
constexpr double kHuberLimit = 3.0;
constexpr int kPasses = 3;
constexpr double kIdleScale = 0.1;

// Integral of a hat: rises from 0 to 1 within one knot to either side.
double rise(double u) {
  u = std::clamp(u, -1.0, 1.0);
  return u < 0.0 ? 0.5 * (u + 1.0) * (u + 1.0) : 1.0 - 0.5 * (1.0 - u) * (1.0 - u);
}

double hat(double u) { return std::max(0.0, 1.0 - std::abs(u)); }

// Position and velocity at any time, by cubic Hermite interpolation between the rows.
class MotionAt {
 public:
  explicit MotionAt(const std::vector<Sample>& rows) : rows_(rows) {}

  MotionEstimate operator()(double time_s) {
    while (at_ + 2 < rows_.size() && rows_[at_ + 1].tool.time_s <= time_s) ++at_;
    const Sample& a = rows_[at_];
    const Sample& b = rows_[at_ + 1];
    const double step_s = b.tool.time_s - a.tool.time_s;
    const double u = std::clamp((time_s - a.tool.time_s) / step_s, 0.0, 1.0);
    const double step_m = b.motion.position_m - a.motion.position_m;
    const double c = step_s * a.motion.velocity_m_per_s - step_m;
    const double d = -step_s * b.motion.velocity_m_per_s + step_m;
    return {a.motion.position_m + u * step_m + u * (1.0 - u) * (c * (1.0 - u) + d * u),
            a.motion.velocity_m_per_s + u * (b.motion.velocity_m_per_s - a.motion.velocity_m_per_s)};
  }

 private:
  const std::vector<Sample>& rows_;
  std::size_t at_ = 0;
};

// The regression of the recording with one lag.
class LagRegression {
 public:
  // `noise_N`: standard deviation of the forces.
  LagRegression(const std::vector<Sample>& rows, double noise_N)
      : rows_(rows), noise_N_(noise_N), block_(blocks_by_path(rows)) {
    std::tie(low_m_, high_m_) = position_range_m(rows);
    const auto force_N = [&](Eigen::Index i) { return rows[static_cast<std::size_t>(i)].force_N; };
    force_N_ = Eigen::VectorXd::NullaryExpr(static_cast<Eigen::Index>(rows.size()), force_N);
    scale_ = 1.0 / (no_force_N(noise_N) + kForceShare * force_N_.array().abs());
  }

  // The cost J of the fit at this lag, by blocks of equal path length.
  BlockCosts costs(double lag_s) const {
    const Design design = design_at(lag_s);
    Eigen::VectorXd scale = scale_;
    Eigen::VectorXd predicted_N;
    for (int pass = 0; pass < kPasses; ++pass) {
      const Design scaled = scale.asDiagonal() * design;
      const Eigen::MatrixXd gram = scaled.transpose() * scaled;
      predicted_N = design * solve_non_negative(gram, scaled.transpose() * scale.cwiseProduct(force_N_));
      for (Eigen::Index i = 0; i < scale.size(); ++i) {
        // An idle row counts a hundredth: without any the next fit would be free there.
        const double idle = is_idle(i, predicted_N(i)) ? kIdleScale : 1.0;
        const double size = std::max(std::abs(error(i, predicted_N(i))), 1e-12);
        scale(i) = scale_(i) * idle * std::sqrt(std::min(1.0, kHuberLimit / size));
      }
    }
    BlockCosts costs(kBlocks, 0.0);
    for (Eigen::Index i = 0; i < force_N_.size(); ++i)
      costs[block_[static_cast<std::size_t>(i)]] += huber(error(i, predicted_N(i)), kHuberLimit);
    return costs;
  }

 private:
  using Design = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Design design_at(double lag_s) const {
    Design design(force_N_.size(), kColumns);
    MotionAt motion_at(rows_);
    std::array<double, kBranch> drive{};
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const MotionEstimate motion = motion_at(rows_[r].tool.time_s - lag_s);
      const double x = (motion.position_m - low_m_) / (high_m_ - low_m_);
      double* row = design.row(static_cast<Eigen::Index>(r)).data();
      row[0] = 1.0;
      row[1] = -1.0;
      for (int k = 0; k < kElastic; ++k) row[2 + k] = rise(x * kElastic - (k + 0.5));
      for (int k = 0; k < kViscous; ++k)
        row[kFirstViscous + k] = motion.velocity_m_per_s * hat(std::clamp(x, 0.0, 1.0) * (kViscous - 1) - k);
      std::array<double, kBranch> rising{};
      for (int k = 0; k < kBranch; ++k) rising[static_cast<std::size_t>(k)] = rise(x * kBranch - (k + 0.5));
      const double step_s = r > 0 ? rows_[r].tool.time_s - rows_[r - 1].tool.time_s : 0.0;
      for (std::size_t t = 0; t < kTimes_s.size(); ++t) {
        const double keep = std::exp(-step_s / kTimes_s[t]);
        const double gain = r > 0 ? kTimes_s[t] * (1.0 - keep) / step_s : 0.0;
        double* state = row + kFirstBranch + kBranch * static_cast<int>(t);
        const double* before = state - kColumns;
        for (std::size_t k = 0; k < kBranch; ++k)
          state[k] = r > 0 ? keep * before[k] + gain * (rising[k] - drive[k]) : 0.0;
      }
      drive = rising;
    }
    return design;
  }

  // Contact is one-sided: where no force is measured the fit may be below 0.
  bool is_idle(Eigen::Index i, double predicted_N) const {
    return predicted_N < 0.0 && std::abs(force_N_(i)) <= no_force_N(noise_N_);
  }

  double error(Eigen::Index i, double predicted_N) const {
    return is_idle(i, predicted_N) ? 0.0 : (force_N_(i) - predicted_N) * scale_(i);
  }

  const std::vector<Sample>& rows_;
  double noise_N_;
  std::vector<std::size_t> block_;
  double low_m_ = 0.0, high_m_ = 0.0;
  Eigen::VectorXd force_N_;
  Eigen::VectorXd scale_;  // 1 / N
};

// Strokes at different speeds distinguish a lag from memory; one press does not.
constexpr int kLeastStrokes = 3;

// Counts how often the tool passes the middle of its range inwards.
int strokes_of(const std::vector<Sample>& rows, double middle_m) {
  int strokes = 0;
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (rows[i - 1].motion.position_m <= middle_m && rows[i].motion.position_m > middle_m) ++strokes;
  return strokes;
}

// The lag beyond the near range with the lowest cost, in coarse steps; 0 if none is clearly better than all near ones.
double far_lag_s(const std::vector<Sample>& rows, double noise_N) {
  std::vector<Sample> some;
  for (std::size_t i = 0; i < rows.size(); i += kFarStride) some.push_back(rows[i]);
  const LagRegression regression(some, noise_N);
  const auto cost = [&](double lag_s) {
    const BlockCosts costs = regression.costs(lag_s);
    return std::accumulate(costs.begin(), costs.end(), 0.0);
  };
  double near = HUGE_VAL;
  for (const double lag_s : {-kFarStep_s, 0.0, kFarStep_s}) near = std::min(near, cost(lag_s));
  double best = kFarGain * near, best_s = 0.0;
  for (int step = 2; step * kFarStep_s < kMostLag_s + 0.5 * kFarStep_s; ++step) {
    for (const double lag_s : {step * kFarStep_s, -step * kFarStep_s}) {
      const double here = cost(lag_s);
      if (here < best) best = here, best_s = lag_s;
    }
  }
  return best_s;
}

}  // namespace

OffsetEstimate find_force_lag(const std::vector<Sample>& rows, double force_noise_N) {
  std::vector<Sample> some;
  for (const Sample& row : rows) {
    if (some.size() == kSearchRows) break;
    if (some.empty() || row.tool.time_s >= some.back().tool.time_s + kCoarse_s) some.push_back(row);
  }
  if (some.size() < 100) return {};
  const double step_s = (some.back().tool.time_s - some.front().tool.time_s) / static_cast<double>(some.size() - 1);
  if (step_s > 10.0 * kAccuracy_s) return {};
  const auto [low_m, high_m] = position_range_m(some);
  if (!(high_m > low_m) || strokes_of(some, 0.5 * (low_m + high_m)) < kLeastStrokes) return {};
  const LagRegression regression(some, force_noise_N);
  double low_s = -kNearLag_s, high_s = kNearLag_s;
  const double far_s = far_lag_s(some, force_noise_N);
  if (std::abs(far_s) > kMostLag_s - kFarStep_s) return {far_s, true, kUnknownError, true, far_s};
  (far_s < 0.0 ? low_s : high_s) += far_s < 0.0 ? std::min(0.0, far_s) : far_s;
  OffsetEstimate lag = estimate_offset([&](double lag_s) { return regression.costs(lag_s); },
                                       {low_s, high_s, kCoarse_s, kFine_s, kAccuracy_s, kAccuracy_s});
  // A long lag that the blocks disagree on by more is still one, within a step of the far search.
  if (!lag.identified && far_s != 0.0)
    lag = {std::abs(lag.minimum_at - far_s) <= kFarStep_s ? lag.minimum_at : far_s, true, 0.5 * kFarStep_s, true,
           far_s};
  // A force that is read once a row is late by anything up to the interval of the rows, evenly distributed.
  lag.standard_error = std::hypot(lag.standard_error, step_s / std::sqrt(12.0));
  if (std::abs(lag.at) < kSignificantErrors * lag.standard_error) lag.at = 0.0;
  return lag;
}

}  // namespace palpate
