#include "engine/tick/motion_estimator.h"

#include <algorithm>
#include <cmath>

#include "engine/tick/lanes.h"
#include "engine/tick/normal_tail.h"

namespace palpate {
namespace {

// Densities of the white jerk that drives the three filters, m^2/s^5: a hand
// at rest with tremor, a hand that moves, a poke. Half-decades around these
// change the velocity error by less than 5 %.
constexpr std::array<double, MotionFilters::kFilters> kJerkDensity{1.0, 30.0, 1000.0};
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
constexpr std::size_t kFilters = MotionFilters::kFilters;
static_assert(kLanes == MotionFilters::kLanes);

double square(double x) noexcept { return x * x; }

// Of the covariance of states i >= j.
constexpr std::size_t at(std::size_t i, std::size_t j) { return i * (i + 1) / 2 + j; }

// One step of the time, and what the sensor says of it.
struct Step {
  double h_s = 0.0;
  double stay = 0.0;  // the chance that the hand is still in its regime
  double position_m = 0.0;
  double position_share = 1.0;  // how much of an observation the position counts for
  double half_encoder_step_m = 0.0;
  double position_variance = 0.0;
  bool has_velocity = false;
  double velocity_m_per_s = 0.0;
  double velocity_variance = 0.0;
  double acceleration_m_per_s2 = 0.0;
  double acceleration_variance = 0.0;
};

// `n`: the states that there are, 4 with an accelerometer, else 3; known to the
// compiler, which unrolls every loop over them.
template <std::size_t n>
struct States {
  V4 mean[n];
  V4 covariance[n * (n + 1) / 2];
  // Of the measurements so far: factor * exp(exponent), apart so that neither underflows.
  V4 factor;
  V4 exponent;
};

PALPATE_INLINE void square_root(V4& x) noexcept {
  for (std::size_t lane = 0; lane < kLanes; ++lane) x[lane] = std::sqrt(x[lane]);
}

// likelihood^share; the shares that come often need no logarithm.
PALPATE_INLINE void share_likelihood(V4& likelihood, double share) noexcept {
  if (share == 1.0) return;
  if (share == 0.5) return square_root(likelihood);
  for (std::size_t f = 0; f < kFilters; ++f) likelihood[f] = std::pow(likelihood[f], share);
}

// Interaction step: each filter starts from the mixture of all, weighted by the
// chance that the hand changed to its regime.
template <std::size_t n>
PALPATE_INLINE void mix(States<n>& x, const MotionFilters& from, double stay) noexcept {
  const double change = (1.0 - stay) / (kFilters - 1);
  V4 weight[kFilters];
  x.factor = V4{};
  for (std::size_t f = 0; f < kFilters; ++f) {
    weight[f] = V4{change, change, change, change};
    weight[f][f] = stay;
    weight[f] *= from.probability[f];
    x.factor += weight[f];
  }
  const V4 scale = 1.0 / x.factor;
  for (V4& one : weight) one *= scale;
  V4 spread[kFilters][n];
  for (std::size_t i = 0; i < n; ++i) {
    x.mean[i] = weight[0] * from.mean[i][0] + weight[1] * from.mean[i][1] + weight[2] * from.mean[i][2];
    for (std::size_t f = 0; f < kFilters; ++f) spread[f][i] = from.mean[i][f] - x.mean[i];
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      V4 sum{};
      for (std::size_t f = 0; f < kFilters; ++f) {
        sum += weight[f] * (from.covariance[at(i, j)][f] + spread[f][i] * spread[f][j]);
      }
      x.covariance[at(i, j)] = sum;
    }
  }
}

// Exact discretisation of a white-jerk motion over `h` seconds:
// P <- F P F^T with F = [1 h h^2/2; 0 1 h; 0 0 1], rows then columns.
template <std::size_t n>
PALPATE_INLINE void predict(States<n>& x, double h) noexcept {
  x.mean[0] += h * (x.mean[1] + 0.5 * h * x.mean[2]);
  x.mean[1] += h * x.mean[2];
  V4 p[3][n];
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < n; ++j) p[i][j] = x.covariance[i >= j ? at(i, j) : at(j, i)];
  }
  for (std::size_t j = 0; j < n; ++j) {
    p[0][j] += h * (p[1][j] + 0.5 * h * p[2][j]);
    p[1][j] += h * p[2][j];
  }
  for (std::size_t i = 0; i < 3; ++i) {
    p[i][0] += h * (p[i][1] + 0.5 * h * p[i][2]);
    p[i][1] += h * p[i][2];
  }
  const V4 q = {kJerkDensity[0], kJerkDensity[1], kJerkDensity[2], kJerkDensity[0]};
  const double h2 = h * h;
  const double h3 = h2 * h;
  x.covariance[at(0, 0)] = p[0][0] + q * (h3 * h2 / 20.0);
  x.covariance[at(1, 0)] = p[0][1] + q * (h2 * h2 / 8.0);
  x.covariance[at(2, 0)] = p[0][2] + q * (h3 / 6.0);
  x.covariance[at(1, 1)] = p[1][1] + q * (h3 / 3.0);
  x.covariance[at(2, 1)] = p[1][2] + q * (h2 / 2.0);
  x.covariance[at(2, 2)] = p[2][2] + q * h;
  if constexpr (n == 4) {
    for (std::size_t j = 0; j < 3; ++j) x.covariance[at(3, j)] = p[j][3];
    x.covariance[at(3, 3)] += square(kBiasWalk) * h;
  }
}

// Takes `column` * shift onto the mean and `column` `column`^T * shrink off the
// covariance, `column` the covariance with what was measured.
template <std::size_t n>
PALPATE_INLINE void correct(States<n>& x, const V4 (&column)[n], const V4& shift, const V4& shrink) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    x.mean[i] += column[i] * shift;
    const V4 share = column[i] * shrink;
    for (std::size_t j = 0; j <= i; ++j) x.covariance[at(i, j)] -= share * column[j];
  }
}

// A measurement of the sum of states `a` and `b`, or of `a` alone where they are the same.
template <std::size_t n>
PALPATE_INLINE void measure_states(States<n>& x, std::size_t a, std::size_t b, double value, double variance) noexcept {
  V4 column[n];
  V4 innovation = value - x.mean[a];
  for (std::size_t i = 0; i < n; ++i) column[i] = x.covariance[i >= a ? at(i, a) : at(a, i)];
  V4 total = variance + column[a];
  if (a != b) {
    innovation -= x.mean[b];
    for (std::size_t i = 0; i < n; ++i) column[i] += x.covariance[i >= b ? at(i, b) : at(b, i)];
    total = variance + (column[a] + column[b]);
  }
  const V4 scale = 1.0 / total;
  correct<n>(x, column, innovation * scale, scale);
  V4 factor = scale;
  square_root(factor);
  x.factor *= factor;
  x.exponent -= 0.5 * innovation * innovation * scale;
}

struct Tails {
  V4 probability;
  V4 density;
};

PALPATE_INLINE void tails(Tails& to, const V4& x) noexcept {
  const V4 size = x < 0.0 ? -x : x;
  const V4 inside = size <= normal_table::kEnd ? size : V4{};  // also of what is no number
  V4 from;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const std::size_t node = normal_table::nearest(inside[lane]);
    from[lane] = normal_table::place(node);
    to.probability[lane] = normal_table::nodes[node].probability;
    to.density[lane] = normal_table::nodes[node].density;
  }
  normal_table::continue_to(inside, from, to.probability, to.density);
  to.probability = size <= normal_table::kEnd ? to.probability : V4{};
  to.density = size <= normal_table::kEnd ? to.density : V4{};
}

template <std::size_t n>
PALPATE_INLINE void measure_position(States<n>& x, const Step& step) noexcept {
  const V4 variance = x.covariance[at(0, 0)] + step.position_variance;
  V4 deviation = variance;
  square_root(deviation);
  const V4 away = step.position_m - x.mean[0];
  const V4 low = (away - step.half_encoder_step_m) / deviation;
  const V4 high = (away + step.half_encoder_step_m) / deviation;
  // Not quantised, or a reading far from the prediction: the nearest edge counts as an
  // ordinary measurement. shift: change of the mean per unit covariance; shrink: loss of
  // covariance.
  const V4 nearest = low > 0.0 ? low : (high < 0.0 ? high : 0.5 * (low + high));
  V4 shift = nearest / deviation;
  V4 shrink = 1.0 / variance;
  V4 factor = (step.half_encoder_step_m > 0.0 ? 2.0 * step.half_encoder_step_m : 1.0) / deviation;
  V4 exponent = -0.5 * nearest * nearest;
  if (step.half_encoder_step_m > 0.0) {
    Tails below;
    Tails above;
    tails(below, low);
    tails(above, high);
    // Without cancellation in either tail.
    const V4 inside = low > 0.0    ? below.probability - above.probability
                      : high < 0.0 ? above.probability - below.probability
                                   : (0.5 - below.probability) + (0.5 - above.probability);
    const V4 scale = 1.0 / (inside > 1e-9 ? inside : V4{1.0, 1.0, 1.0, 1.0});
    const V4 mean = (below.density - above.density) * scale;
    V4 rest = mean * mean - (low * below.density - high * above.density) * scale;  // 1 - the variance left
    rest = rest < 0.0 ? V4{} : (rest > 1.0 ? V4{1.0, 1.0, 1.0, 1.0} : rest);
    shift = inside > 1e-9 ? mean / deviation : shift;
    shrink = inside > 1e-9 ? rest / variance : shrink;
    factor = inside > 1e-9 ? inside : factor;
    exponent = inside > 1e-9 ? V4{} : exponent;
  }
  share_likelihood(factor, step.position_share);
  x.factor *= factor;
  x.exponent += exponent * step.position_share;
  V4 column[n];
  for (std::size_t i = 0; i < n; ++i) column[i] = x.covariance[at(i, 0)];
  correct<n>(x, column, shift * step.position_share, shrink * step.position_share);
}

// Only ratios of likelihoods count: the greatest exponent is taken off, so that none
// underflows.
template <std::size_t n>
PALPATE_INLINE void weigh(const States<n>& x, MotionFilters& filters) noexcept {
  double exponent = x.exponent[0];
  for (std::size_t f = 1; f < kFilters; ++f) exponent = std::max(exponent, x.exponent[f]);
  double largest = 0.0;
  for (std::size_t f = 0; f < kFilters; ++f) {
    const double below = x.exponent[f] - exponent;
    filters.probability[f] = x.factor[f] * (below < 0.0 ? std::exp(below) : 1.0);
    largest = std::max(largest, filters.probability[f]);
  }
  double total = 0.0;
  for (std::size_t f = 0; f < kFilters; ++f) {
    filters.probability[f] = std::max(filters.probability[f], kProbabilityFloor * largest);
    total += filters.probability[f];
  }
  const double scale = 1.0 / total;
  for (std::size_t f = 0; f < kFilters; ++f) filters.probability[f] *= scale;
}

template <std::size_t n>
PALPATE_INLINE void advance_by(MotionFilters& filters, const Step& step) noexcept {
  States<n> x;
  mix<n>(x, filters, step.stay);
  predict<n>(x, step.h_s);
  x.exponent = V4{};
  if constexpr (n == 4) measure_states<n>(x, 2, 3, step.acceleration_m_per_s2, step.acceleration_variance);
  if (step.has_velocity) measure_states<n>(x, 1, 1, step.velocity_m_per_s, step.velocity_variance);
  measure_position<n>(x, step);
  weigh<n>(x, filters);
  for (std::size_t i = 0; i < n; ++i) store(filters.mean[i], x.mean[i]);
  for (std::size_t k = 0; k < n * (n + 1) / 2; ++k) store(filters.covariance[k], x.covariance[k]);
}

using Advance = void (*)(MotionFilters&, const Step&);

template <std::size_t n>
void advance(MotionFilters& filters, const Step& step) noexcept {
  advance_by<n>(filters, step);
}

#ifdef __x86_64__
// The same operations with four lanes to an instruction: the same bits.
template <std::size_t n>
[[gnu::target("avx2")]] void advance_wide(MotionFilters& filters, const Step& step) noexcept {
  advance_by<n>(filters, step);
}

template <std::size_t n>
Advance best_advance() noexcept {
  return has_wide_lanes() ? &advance_wide<n> : &advance<n>;
}
#else
template <std::size_t n>
Advance best_advance() noexcept {
  return &advance<n>;
}
#endif

const Advance kAdvanceOfPosition = best_advance<3>();
const Advance kAdvanceWithAccelerometer = best_advance<4>();

}  // namespace

MotionEstimator::MotionEstimator(const SensorSpec& sensor) noexcept : sensor_(sensor) {}

void MotionEstimator::start(const ToolSample& sample) noexcept {
  // Broad: 0.1 m/s, 1 m/s^2, and a bias that may even hold gravity.
  const double resolution_m = std::max(sensor_.encoder_step_m, 1e-9);
  filters_ = {};
  filters_.mean[0].fill(sample.position_m);
  filters_.mean[1].fill(sensor_.has_velocity ? sample.velocity_m_per_s : 0.0);
  filters_.covariance[at(0, 0)].fill(square(resolution_m) / 12.0 + square(sensor_.position_noise_m));
  filters_.covariance[at(1, 1)].fill(1e-2);
  filters_.covariance[at(2, 2)].fill(1.0);
  filters_.covariance[at(3, 3)].fill(sensor_.has_acceleration ? 100.0 : 0.0);
  for (std::size_t f = 0; f < kFilters; ++f) filters_.probability[f] = 1.0 / kFilters;
  estimate_ = {filters_.mean[0][0], filters_.mean[1][0]};
  time_s_ = sample.time_s;
  position_m_ = sample.position_m;
  started_ = true;
}

MotionEstimate MotionEstimator::update(const ToolSample& sample) noexcept {
  if (!started_) {
    start(sample);
    return estimate_;
  }
  const double step_s = sample.time_s - time_s_;
  if (!(step_s > 0.0)) return estimate_;
  time_s_ = sample.time_s;
  if (step_s != stay_step_s_) {
    stay_step_s_ = step_s;
    stay_ = std::exp(-step_s / kDwell_s);
  }
  // A step of a millisecond less rounding is one of a millisecond.
  const double repeated_share = std::min(1.0, (1.0 + 1e-9) * step_s / kRepeatedStep_s);
  const bool repeated = sensor_.encoder_step_m > 0.0 && sample.position_m == position_m_;
  position_m_ = sample.position_m;
  const double edge_noise_m = kEdgeNoiseFraction * sensor_.encoder_step_m;
  Step step;
  step.h_s = step_s;
  step.stay = stay_;
  step.position_m = sample.position_m;
  step.position_share = repeated ? kRepeatedShare * repeated_share : 1.0;
  step.half_encoder_step_m = 0.5 * sensor_.encoder_step_m;
  step.position_variance = std::max(square(sensor_.position_noise_m) + square(edge_noise_m), 1e-18);  // (1 nm)^2
  step.has_velocity = sensor_.has_velocity;
  step.velocity_m_per_s = sample.velocity_m_per_s;
  step.velocity_variance = square(sensor_.velocity_noise_m_per_s);
  step.acceleration_m_per_s2 = sample.acceleration_m_per_s2;
  step.acceleration_variance = square(sensor_.acceleration_noise_m_per_s2);
  (sensor_.has_acceleration ? kAdvanceWithAccelerometer : kAdvanceOfPosition)(filters_, step);
  estimate_ = {};
  for (std::size_t f = 0; f < kFilters; ++f) {
    estimate_.position_m += filters_.probability[f] * filters_.mean[0][f];
    estimate_.velocity_m_per_s += filters_.probability[f] * filters_.mean[1][f];
  }
  return estimate_;
}

}  // namespace palpate
