#include "engine/tick/motion_estimator.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// Densities of the white jerk that drives the three filters, m^2/s^5: a hand
// at rest with tremor, a hand that moves, a poke. Half-decades around these
// change the velocity error by less than 5 %.
constexpr std::array<double, 3> kJerkDensity{1.0, 30.0, 1000.0};
// How long a hand stays in one of these regimes on average.
constexpr double kDwell_s = 0.2;
// Random walk of the accelerometer's bias, m/s^2 per sqrt(s) (ADXL330 class).
constexpr double kBiasWalk = 0.05;
// An encoder's edges are not perfect; this fraction of a step is left as noise.
constexpr double kEdgeNoiseFraction = 0.02;
// A reading that has not changed says little new: each conditioning on the same
// interval forgets that the last one cut the tail off, and many of them push the
// estimate away from an edge that it is about to cross. So a repeated reading
// counts for this share of an observation per millisecond, and less when they
// come faster. Of 1, 0.7, 0.5, 0.35 the best on each of five trajectories.
constexpr double kRepeatedShare = 0.5;
constexpr double kRepeatedStep_s = 1e-3;
// No filter is ever ruled out for good.
constexpr double kProbabilityFloor = 1e-6;
constexpr double kInverseSqrt2Pi = 0.3989422804014327;
constexpr double kInverseSqrt2 = 0.7071067811865476;

double square(double x) noexcept { return x * x; }

// Probability that a standard normal lies between a < b, without cancellation
// in either tail.
double normal_between(double a, double b) noexcept {
  if (a > 0.0) return 0.5 * (std::erfc(a * kInverseSqrt2) - std::erfc(b * kInverseSqrt2));
  if (b < 0.0) return 0.5 * (std::erfc(-b * kInverseSqrt2) - std::erfc(-a * kInverseSqrt2));
  return 0.5 * (std::erf(b * kInverseSqrt2) - std::erf(a * kInverseSqrt2));
}

}  // namespace

MotionEstimator::MotionEstimator(const SensorSpec& sensor) noexcept
    : sensor_(sensor) {
  static_assert(kJerkDensity.size() == kFilters);
}

void MotionEstimator::start(const ToolSample& sample) noexcept {
  for (Filter& filter : filters_) {
    filter = Filter{};
    filter.mean = {sample.position_m, sensor_.has_velocity ? sample.velocity_m_per_s : 0.0, 0.0, 0.0};
    // Broad: 0.1 m/s, 1 m/s^2, and a bias that may even hold gravity.
    const double resolution_m = std::max(sensor_.encoder_step_m, 1e-9);
    filter.covariance[0][0] = square(resolution_m) / 12.0 + square(sensor_.position_noise_m);
    filter.covariance[1][1] = 1e-2;
    filter.covariance[2][2] = 1.0;
    filter.covariance[3][3] = sensor_.has_acceleration ? 100.0 : 0.0;
  }
  estimate_ = {filters_[0].mean[0], filters_[0].mean[1]};
  time_s_ = sample.time_s;
  position_m_ = sample.position_m;
  started_ = true;
}

// Interaction step: each filter starts from the mixture of all, weighted by the
// chance that the hand changed to its regime.
template <std::size_t n>
void MotionEstimator::mix(double step_s) noexcept {
  const double stay = std::exp(-step_s / kDwell_s);
  const double change = (1.0 - stay) / (kFilters - 1);
  for (std::size_t to = 0; to < kFilters; ++to) {
    Filter& mixed = mixed_[to];
    mixed = Filter{};
    std::array<double, kFilters> weight{};
    double total = 0.0;
    for (std::size_t from = 0; from < kFilters; ++from) {
      weight[from] = (from == to ? stay : change) * filters_[from].probability;
      total += weight[from];
    }
    mixed.probability = total;
    for (std::size_t from = 0; from < kFilters; ++from) {
      weight[from] /= total;
      for (std::size_t i = 0; i < n; ++i) mixed.mean[i] += weight[from] * filters_[from].mean[i];
    }
    for (std::size_t from = 0; from < kFilters; ++from) {
      Vector spread{};
      for (std::size_t i = 0; i < n; ++i) spread[i] = filters_[from].mean[i] - mixed.mean[i];
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
          mixed.covariance[i][j] += weight[from] * (filters_[from].covariance[i][j] + spread[i] * spread[j]);
        }
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < i; ++j) mixed.covariance[j][i] = mixed.covariance[i][j];
    }
  }
  filters_ = mixed_;
}

// Exact discretisation of a white-jerk motion over `step_s`.
template <std::size_t n>
void MotionEstimator::predict(Filter& filter, double jerk_density, double step_s) const noexcept {
  const double h = step_s;
  Vector& x = filter.mean;
  x[0] += h * (x[1] + 0.5 * h * x[2]);
  x[1] += h * x[2];
  // P <- F P F^T with F = [1 h h^2/2; 0 1 h; 0 0 1], rows then columns.
  Matrix& p = filter.covariance;
  for (std::size_t j = 0; j < n; ++j) {
    p[0][j] += h * (p[1][j] + 0.5 * h * p[2][j]);
    p[1][j] += h * p[2][j];
  }
  for (std::size_t i = 0; i < n; ++i) {
    p[i][0] += h * (p[i][1] + 0.5 * h * p[i][2]);
    p[i][1] += h * p[i][2];
  }
  const double q = jerk_density;
  const double h2 = h * h;
  const double h3 = h2 * h;
  p[0][0] += q * h3 * h2 / 20.0;
  p[0][1] += q * h2 * h2 / 8.0;
  p[0][2] += q * h3 / 6.0;
  p[1][1] += q * h3 / 3.0;
  p[1][2] += q * h2 / 2.0;
  p[2][2] += q * h;
  p[1][0] = p[0][1];
  p[2][0] = p[0][2];
  p[2][1] = p[1][2];
  if constexpr (n == 4) p[3][3] += square(kBiasWalk) * h;
}

template <std::size_t n>
double MotionEstimator::measure_position(Filter& filter, double position_m, double share) const noexcept {
  const double edge_noise_m = kEdgeNoiseFraction * sensor_.encoder_step_m;
  const double noise_variance =
      std::max(square(sensor_.position_noise_m) + square(edge_noise_m), 1e-18);  // (1 nm)^2
  const double variance = filter.covariance[0][0] + noise_variance;
  const double deviation = std::sqrt(variance);
  const double half_step = 0.5 * sensor_.encoder_step_m;
  // shift: change of the mean per unit covariance; shrink: loss of covariance.
  double shift = 0.0;
  double shrink = 0.0;
  double log_likelihood = 0.0;
  const double low = (position_m - half_step - filter.mean[0]) / deviation;
  const double high = (position_m + half_step - filter.mean[0]) / deviation;
  const double inside = half_step > 0.0 ? normal_between(low, high) : 0.0;
  if (inside > 1e-9) {
    const double density_low = kInverseSqrt2Pi * std::exp(-0.5 * low * low);
    const double density_high = kInverseSqrt2Pi * std::exp(-0.5 * high * high);
    const double mean = (density_low - density_high) / inside;
    const double spread = 1.0 + (low * density_low - high * density_high) / inside - mean * mean;
    shift = mean / deviation;
    shrink = (1.0 - std::clamp(spread, 0.0, 1.0)) / variance;
    log_likelihood = std::log(inside);
  } else {
    // Not quantised, or a reading far from the prediction: the nearest edge
    // counts as an ordinary measurement.
    const double nearest = low > 0.0 ? low : (high < 0.0 ? high : 0.5 * (low + high));
    shift = nearest / deviation;
    shrink = 1.0 / variance;
    log_likelihood = -0.5 * nearest * nearest - std::log(deviation);
    if (half_step > 0.0) log_likelihood += std::log(2.0 * half_step);
  }
  shift *= share;
  shrink *= share;
  Vector column{};
  for (std::size_t i = 0; i < n; ++i) column[i] = filter.covariance[i][0];
  for (std::size_t i = 0; i < n; ++i) {
    filter.mean[i] += column[i] * shift;
    for (std::size_t j = 0; j < n; ++j) filter.covariance[i][j] -= column[i] * column[j] * shrink;
  }
  return share * log_likelihood;
}

template <std::size_t n>
double MotionEstimator::measure_scalar(Filter& filter, const Vector& row, double value,
                                       double variance) const noexcept {
  Vector column{};
  double total = variance;
  double innovation = value;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) column[i] += filter.covariance[i][j] * row[j];
  }
  for (std::size_t i = 0; i < n; ++i) {
    total += row[i] * column[i];
    innovation -= row[i] * filter.mean[i];
  }
  for (std::size_t i = 0; i < n; ++i) {
    filter.mean[i] += column[i] * innovation / total;
    for (std::size_t j = 0; j < n; ++j) filter.covariance[i][j] -= column[i] * column[j] / total;
  }
  return -0.5 * innovation * innovation / total - 0.5 * std::log(total);
}

MotionEstimate MotionEstimator::update(const ToolSample& sample) noexcept {
  if (!started_) {
    start(sample);
    return estimate_;
  }
  const double step_s = sample.time_s - time_s_;
  if (!(step_s > 0.0)) return estimate_;
  time_s_ = sample.time_s;
  if (sensor_.has_acceleration) {
    advance<4>(sample, step_s);
  } else {
    advance<3>(sample, step_s);
  }
  return estimate_;
}

template <std::size_t n>
void MotionEstimator::advance(const ToolSample& sample, double step_s) noexcept {
  mix<n>(step_s);
  const bool repeated = sensor_.encoder_step_m > 0.0 && sample.position_m == position_m_;
  const double share = repeated ? kRepeatedShare * std::min(1.0, step_s / kRepeatedStep_s) : 1.0;
  position_m_ = sample.position_m;
  std::array<double, kFilters> log_weight{};
  for (std::size_t f = 0; f < kFilters; ++f) {
    Filter& filter = filters_[f];
    predict<n>(filter, kJerkDensity[f], step_s);
    double log_likelihood = 0.0;
    if constexpr (n == 4) {
      log_likelihood += measure_scalar<n>(filter, {0.0, 0.0, 1.0, 1.0}, sample.acceleration_m_per_s2,
                                       square(sensor_.acceleration_noise_m_per_s2));
    }
    if (sensor_.has_velocity) {
      log_likelihood += measure_scalar<n>(filter, {0.0, 1.0, 0.0, 0.0}, sample.velocity_m_per_s,
                                       square(sensor_.velocity_noise_m_per_s));
    }
    log_likelihood += measure_position<n>(filter, sample.position_m, share);
    log_weight[f] = std::log(filter.probability) + log_likelihood;
  }
  const double largest = *std::max_element(log_weight.begin(), log_weight.end());
  double total = 0.0;
  for (std::size_t f = 0; f < kFilters; ++f) {
    filters_[f].probability = std::max(std::exp(log_weight[f] - largest), kProbabilityFloor);
    total += filters_[f].probability;
  }
  estimate_ = {};
  for (Filter& filter : filters_) {
    filter.probability /= total;
    estimate_.position_m += filter.probability * filter.mean[0];
    estimate_.velocity_m_per_s += filter.probability * filter.mean[1];
  }
}

}  // namespace palpate
