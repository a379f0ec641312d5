// The motion estimator (engine/tick/motion_estimator.h) as C99 text, for positions
// alone. `real`, R(), EXP and SQRT are the file's; no other function of libm is used:
// the logarithm is a series after the exponent was taken off, the error function a
// series near 0 and beyond it the Chebyshev expansion of exp(x^2) erfc(x) (1 + 2x) in
// (x - 3.75) / (x + 3.75), coefficients computed with 60 digits.
// Source: Shepherd & Laframboise (1981) for that expansion.
#pragma once

namespace palpate {

inline constexpr const char* kMotionC = R"C(
/* ---- motion: three Kalman filters, mixed by how well each predicts the samples ---- */

typedef struct {
  real mean[3]; /* position, velocity, acceleration */
  real covariance[3][3];
  real probability;
} Filter;

static Filter filters[3];
static real last_time_s;
static real last_position_m;
static real position_estimate_m;
static real velocity_estimate_m_per_s;
static int started;

static real larger(real a, real b) { return a < b ? b : a; }
static real smaller(real a, real b) { return b < a ? b : a; }
static real clamped(real x, real low, real high) { return x < low ? low : (high < x ? high : x); }
static real absolute(real x) { return x < R(0.0) ? -x : x; }
static int finite_number(real x) { return x - x == R(0.0); }

static real logarithm_series(real m) { /* of m between sqrt(1/2) and sqrt(2) */
  static const real term[10] = {R(1.0) / R(21.0), R(1.0) / R(19.0), R(1.0) / R(17.0), R(1.0) / R(15.0),
                                R(1.0) / R(13.0), R(1.0) / R(11.0), R(1.0) / R(9.0),  R(1.0) / R(7.0),
                                R(1.0) / R(5.0),  R(1.0) / R(3.0)};
  const real s = (m - R(1.0)) / (m + R(1.0));
  real sum = R(0.0);
  int k;
  for (k = 0; k < 10; ++k) sum = (sum + term[k]) * (s * s);
  return R(2.0) * (s + s * sum);
}

static real logarithm(real x) { /* x > 0 and not denormal */
  union {
    real value;
    Bits bits;
  } u;
  int exponent;
  u.value = x;
  exponent = (int)(u.bits >> MANTISSA_BITS) - EXPONENT_BIAS;
  u.bits = (u.bits & MANTISSA_MASK) | EXPONENT_OF_ONE;
  if (u.value > R(1.4142135623730951)) {
    u.value *= R(0.5);
    ++exponent;
  }
  return (real)exponent * R(0.6931471805599453) + logarithm_series(u.value);
}

static real erfc_positive(real x) { /* x >= 0 */
  static const real chebyshev[24] = {
    R(1.17757893456740170e+00), R(-4.59005458064647760e-03), R(-8.42491333665179170e-02),
    R(5.92099399981918933e-02), R(-2.66586684353057531e-02), R(9.07499767070526520e-03),
    R(-2.41316354041760808e-03), R(4.90775836525808627e-04), R(-6.91697330250120695e-05),
    R(4.13902798607301018e-06), R(7.74038306619849033e-07), R(-2.18864010492343965e-07),
    R(1.07649994656709100e-08), R(4.52195981121828664e-09), R(-7.75440020883135088e-10),
    R(-6.31808834088668410e-11), R(2.86879501093066987e-11), R(1.94558685457773468e-13),
    R(-9.65469674843343926e-13), R(3.25254814814874010e-14), R(3.34781194828680559e-14),
    R(-1.86456288041931304e-15), R(-1.25079505306886479e-15), R(7.41823525662404405e-17)};
  const real t = (x - R(3.75)) / (x + R(3.75));
  real b = R(0.0);
  real before = R(0.0);
  int k;
  for (k = 23; k > 0; --k) {
    const real next = R(2.0) * t * b - before + chebyshev[k];
    before = b;
    b = next;
  }
  return EXP(-x * x) * (t * b - before + chebyshev[0]) / (R(1.0) + R(2.0) * x);
}

static real erf_small(real x) { /* |x| <= 1/2 */
  static const real term[13] = {
      R(1.12837916709551257), R(-3.76126389031837525e-1), R(1.12837916709551257e-1),
      R(-2.68661706451312518e-2), R(5.22397762544218784e-3), R(-8.54832702345085283e-4),
      R(1.20553329817896643e-4), R(-1.4925650358406251e-5), R(1.64621143658892474e-6),
      R(-1.63658446912349243e-7), R(1.48071928158792172e-8), R(-1.22905553017179274e-9),
      R(9.42275906465041097e-11)};
  real sum = R(0.0);
  int k;
  for (k = 12; k >= 0; --k) sum = sum * (x * x) + term[k];
  return x * sum;
}

static real erf_of(real x) {
  if (absolute(x) <= R(0.5)) return erf_small(x);
  return x > R(0.0) ? R(1.0) - erfc_positive(x) : erfc_positive(-x) - R(1.0);
}

static real erfc_of(real x) { return x <= R(0.5) ? R(1.0) - erf_of(x) : erfc_positive(x); }

static real normal_between(real a, real b) { /* probability of a standard normal, a < b */
  const real inverse_root_2 = R(0.7071067811865476);
  if (a > R(0.0)) return R(0.5) * (erfc_of(a * inverse_root_2) - erfc_of(b * inverse_root_2));
  if (b < R(0.0)) return R(0.5) * (erfc_of(-b * inverse_root_2) - erfc_of(-a * inverse_root_2));
  return R(0.5) * (erf_of(b * inverse_root_2) - erf_of(a * inverse_root_2));
}

static void start_motion(real position_m) {
  static const Filter nothing = {{R(0.0)}, {{R(0.0)}}, R(0.0)};
  const real resolution_m = larger(R(PALPATE_ENCODER_STEP_M), R(1e-9));
  int f;
  for (f = 0; f < 3; ++f) {
    filters[f] = nothing;
    filters[f].mean[0] = position_m;
    filters[f].covariance[0][0] =
        resolution_m * resolution_m / R(12.0) + R(PALPATE_POSITION_NOISE_M) * R(PALPATE_POSITION_NOISE_M);
    filters[f].covariance[1][1] = R(1e-2);
    filters[f].covariance[2][2] = R(1.0);
    filters[f].probability = R(1.0) / R(3.0);
  }
  position_estimate_m = position_m;
  velocity_estimate_m_per_s = R(0.0);
}

/* Each filter starts from the mixture of all, weighted by the chance that the hand
   changed to its regime. */
static void mix_filters(real step_s) {
  const real stay = EXP(-step_s / R(0.2));
  const real change = (R(1.0) - stay) / R(2.0);
  const Filter before[3] = {filters[0], filters[1], filters[2]};
  int to, from, i, j;
  for (to = 0; to < 3; ++to) {
    Filter *const into = &filters[to];
    real weight[3];
    into->probability = R(0.0);
    for (from = 0; from < 3; ++from) {
      weight[from] = (from == to ? stay : change) * before[from].probability;
      into->probability += weight[from];
    }
    for (from = 0; from < 3; ++from) weight[from] /= into->probability;
    for (i = 0; i < 3; ++i) {
      into->mean[i] = R(0.0);
      for (from = 0; from < 3; ++from) into->mean[i] += weight[from] * before[from].mean[i];
      for (j = 0; j <= i; ++j) {
        real sum = R(0.0);
        for (from = 0; from < 3; ++from) {
          const real spread = (before[from].mean[i] - into->mean[i]) * (before[from].mean[j] - into->mean[j]);
          sum += weight[from] * (before[from].covariance[i][j] + spread);
        }
        into->covariance[i][j] = into->covariance[j][i] = sum;
      }
    }
  }
}

/* Exact discretisation of a white-jerk motion over `h` seconds, density q. */
static void predict_filter(Filter *filter, real q, real h) {
  real *const x = filter->mean;
  real(*const p)[3] = filter->covariance;
  const real h2 = h * h;
  const real h3 = h2 * h;
  int i;
  x[0] += h * (x[1] + R(0.5) * h * x[2]);
  x[1] += h * x[2];
  for (i = 0; i < 3; ++i) {
    p[0][i] += h * (p[1][i] + R(0.5) * h * p[2][i]);
    p[1][i] += h * p[2][i];
  }
  for (i = 0; i < 3; ++i) {
    p[i][0] += h * (p[i][1] + R(0.5) * h * p[i][2]);
    p[i][1] += h * p[i][2];
  }
  p[0][0] += q * h3 * h2 / R(20.0);
  p[0][1] += q * h2 * h2 / R(8.0);
  p[0][2] += q * h3 / R(6.0);
  p[1][1] += q * h3 / R(3.0);
  p[1][2] += q * h2 / R(2.0);
  p[2][2] += q * h;
  p[1][0] = p[0][1];
  p[2][0] = p[0][2];
  p[2][1] = p[1][2];
}

/* Conditions on the position being within half a step of the reading; returns the
   logarithm of its likelihood. `share`: of an observation, 0 to 1. */
static real measure_position(Filter *filter, real position_m, real share) {
  const real step_m = R(PALPATE_ENCODER_STEP_M);
  const real edge_noise_m = R(0.02) * step_m;
  const real noise = larger(
      R(PALPATE_POSITION_NOISE_M) * R(PALPATE_POSITION_NOISE_M) + edge_noise_m * edge_noise_m, NOISE_FLOOR_M2);
  const real variance = filter->covariance[0][0] + noise;
  const real deviation = SQRT(variance);
  const real half_step = R(0.5) * step_m;
  const real low = (position_m - half_step - filter->mean[0]) / deviation;
  const real high = (position_m + half_step - filter->mean[0]) / deviation;
  const real inside = half_step > R(0.0) ? normal_between(low, high) : R(0.0);
  real shift, shrink, likelihood;
  real column[3];
  int i, j;
  if (inside > R(1e-9)) {
    const real density_low = R(0.3989422804014327) * EXP(R(-0.5) * low * low);
    const real density_high = R(0.3989422804014327) * EXP(R(-0.5) * high * high);
    const real mean = (density_low - density_high) / inside;
    const real spread = R(1.0) + (low * density_low - high * density_high) / inside - mean * mean;
    shift = mean / deviation;
    shrink = (R(1.0) - clamped(spread, R(0.0), R(1.0))) / variance;
    likelihood = logarithm(inside);
  } else {
    const real nearest = low > R(0.0) ? low : (high < R(0.0) ? high : R(0.5) * (low + high));
    shift = nearest / deviation;
    shrink = R(1.0) / variance;
    likelihood = R(-0.5) * nearest * nearest - logarithm(deviation);
    if (half_step > R(0.0)) likelihood += logarithm(R(2.0) * half_step);
  }
  shift *= share;
  shrink *= share;
  for (i = 0; i < 3; ++i) column[i] = filter->covariance[i][0];
  for (i = 0; i < 3; ++i) {
    filter->mean[i] += column[i] * shift;
    for (j = 0; j < 3; ++j) filter->covariance[i][j] -= column[i] * column[j] * shrink;
  }
  return share * likelihood;
}

static void update_motion(real step_s, real position_m) {
  static const real jerk_density[3] = {R(1.0), R(30.0), R(1000.0)};
  const int repeated = R(PALPATE_ENCODER_STEP_M) > R(0.0) && position_m == last_position_m;
  const real share = repeated ? R(0.5) * smaller(R(1.0), step_s / R(1e-3)) : R(1.0);
  real weight[3];
  real largest = R(0.0);
  real total = R(0.0);
  int f;
  mix_filters(step_s);
  for (f = 0; f < 3; ++f) {
    predict_filter(&filters[f], jerk_density[f], step_s);
    weight[f] = measure_position(&filters[f], position_m, share);
    weight[f] += logarithm(filters[f].probability);
    largest = f == 0 ? weight[0] : larger(largest, weight[f]);
  }
  for (f = 0; f < 3; ++f) {
    filters[f].probability = larger(EXP(weight[f] - largest), R(1e-6));
    total += filters[f].probability;
  }
  position_estimate_m = R(0.0);
  velocity_estimate_m_per_s = R(0.0);
  for (f = 0; f < 3; ++f) {
    filters[f].probability /= total;
    position_estimate_m += filters[f].probability * filters[f].mean[0];
    velocity_estimate_m_per_s += filters[f].probability * filters[f].mean[1];
  }
}
)C";

}  // namespace palpate
