#include "models/check/force_lag.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace palpate {
namespace {

constexpr double kStep_s = 0.005;
constexpr std::size_t kMostSteps = 6000;  // 30 s are enough and take some 10 ms
constexpr int kLeastLag = -4;             // steps
constexpr int kMostLag = 20;
constexpr std::array<double, 2> kRelaxation_s = {0.08, 0.8};
constexpr int kPowers = 2;
constexpr int kTerms = 1 + 3 * kPowers;

// Means over even steps; where a gap left none, the last value stays.
struct EvenSeries {
  std::vector<double> position_m;
  std::vector<double> force_N;
};

EvenSeries even_series(const Recording& recording) {
  EvenSeries series;
  const auto& rows = recording.rows;
  const double start_s = rows.front().time_s;
  std::size_t i = 0;
  for (std::size_t step = 0; step < kMostSteps && i < rows.size(); ++step) {
    const double end_s = start_s + kStep_s * static_cast<double>(step + 1);
    double position_m = 0.0;
    double force_N = 0.0;
    int count = 0;
    for (; i < rows.size() && rows[i].time_s < end_s; ++i, ++count) {
      position_m += rows[i].position_m;
      force_N += rows[i].force_N;
    }
    series.position_m.push_back(count > 0 ? position_m / count : series.position_m.back());
    series.force_N.push_back(count > 0 ? force_N / count : series.force_N.back());
  }
  return series;
}

using Terms = Eigen::Matrix<double, kTerms, 1>;
using Square = Eigen::Matrix<double, kTerms, kTerms>;

// The terms of every step without a lag; a lag only moves them along.
std::vector<Terms> terms_of(const EvenSeries& series, double surface_m, double deepest_m) {
  std::vector<Terms> all;
  all.reserve(series.position_m.size());
  std::array<double, 2> share{};
  for (std::size_t r = 0; r < share.size(); ++r) share[r] = 1.0 - std::exp(-kStep_s / kRelaxation_s[r]);
  std::array<std::array<double, kPowers>, 2> relaxed{};
  for (const double position_m : series.position_m) {
    const double u = std::max(0.0, position_m - surface_m) / deepest_m;
    Terms terms;
    terms(0) = 1.0;
    double power = 1.0;
    for (int k = 0; k < kPowers; ++k) {
      power *= u;
      terms(1 + k) = power;
      for (std::size_t r = 0; r < relaxed.size(); ++r) {
        double& state = relaxed[r][static_cast<std::size_t>(k)];
        state += (power - state) * share[r];
        terms(1 + kPowers * (1 + static_cast<int>(r)) + k) = state;
      }
    }
    all.push_back(terms);
  }
  return all;
}

// The regressions of the force on the terms, for every lag: steps `kMostLag` to
// `count + kLeastLag` of the force, each on the terms `lag` steps earlier.
class LaggedRegressions {
 public:
  LaggedRegressions(const EvenSeries& series, const std::vector<Terms>& terms)
      : terms_(terms), force_N_(series.force_N), end_(static_cast<int>(terms.size()) + kLeastLag) {
    for (int i = kMostLag; i < end_; ++i) squares_ += force(i) * force(i);
    // What all lags have in common.
    common_ = gram(kMostLag - kLeastLag, end_ - kMostLag);
  }

  double residual(int lag) const {
    Square normal = common_ + gram(kMostLag - lag, kMostLag - kLeastLag) + gram(end_ - kMostLag, end_ - lag);
    Terms right = Terms::Zero();
    for (int i = kMostLag; i < end_; ++i) right += term(i - lag) * force(i);
    // The terms are of order one; this keeps a term that never changes harmless.
    normal.diagonal().array() += 1e-9 * static_cast<double>(terms_.size());
    const Terms weights = normal.selfadjointView<Eigen::Lower>().ldlt().solve(right);
    return std::sqrt(std::max(0.0, squares_ - weights.dot(right)));
  }

 private:
  const Terms& term(int i) const { return terms_[static_cast<std::size_t>(i)]; }
  double force(int i) const { return force_N_[static_cast<std::size_t>(i)]; }

  Square gram(int begin, int end) const {
    Square sum = Square::Zero();
    for (int i = begin; i < end; ++i) sum += term(i) * term(i).transpose();
    return sum;
  }

  const std::vector<Terms>& terms_;
  const std::vector<double>& force_N_;
  int end_;
  double squares_ = 0.0;
  Square common_;
};

}  // namespace

ForceLag find_force_lag(const Recording& recording) {
  ForceLag found;
  const auto& rows = recording.rows;
  const double mean_step_s = (rows.back().time_s - rows.front().time_s) / static_cast<double>(rows.size() - 1);
  if (mean_step_s > 2.0 * kStep_s) return found;
  const EvenSeries series = even_series(recording);
  if (series.position_m.size() < 100) return found;
  const double deepest_m = *std::max_element(series.position_m.begin(), series.position_m.end());
  if (!(deepest_m > 0.0)) return found;
  found.known = true;
  double without = HUGE_VAL;
  double best = HUGE_VAL;
  // A late force makes the surface seem to lie elsewhere, so it is looked for here.
  for (const double share : {-0.15, -0.05, 0.0, 0.05, 0.15}) {
    const auto terms = terms_of(series, share * deepest_m, deepest_m);
    const LaggedRegressions regressions(series, terms);
    for (int lag = kLeastLag; lag <= kMostLag; ++lag) {
      const double one = regressions.residual(lag);
      if (lag == 0) without = std::min(without, one);
      if (one >= best) continue;
      best = one;
      found.lag_s = lag * kStep_s;
    }
  }
  found.improvement = without > 0.0 ? best / without : 1.0;
  return found;
}

Recording without_lag(const Recording& recording, double lag_s) {
  Recording moved = recording;
  const auto& rows = recording.rows;
  std::size_t late = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    while (late < rows.size() && rows[late].time_s < rows[i].time_s + lag_s) ++late;
    if (late == rows.size()) {
      moved.rows.resize(i);
      break;
    }
    moved.rows[i].force_N = rows[late].force_N;
  }
  return moved;
}

}  // namespace palpate
