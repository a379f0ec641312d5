#include "engine/tick/motion_estimator.h"

#include <cmath>
#include <limits>
#include <vector>

#include "engine/base/statistics.h"

namespace palpate {

MotionEstimate MotionEstimator::update(const ToolSample& sample) noexcept {
  using namespace motion_filter;
  const double step_s = sample.time_s - time_s_;
  if (state_.started != 0 && !(step_s > 0.0)) return estimate();
  time_s_ = sample.time_s;
  const bool repeated = state_.started != 0 && sample.position_m == state_.position_m;
  if (sensor_.has_acceleration)
    measure_acceleration(&state_, sample.acceleration_m_per_s2, sensor_.acceleration_noise_m_per_s2);
  const double h_s = advance_motion(&state_, step_s, sample.position_m);
  if (!(h_s > 0.0)) return estimate();
  if (sensor_.has_velocity) measure_velocity(&state_, sample.velocity_m_per_s, square(sensor_.velocity_noise_m_per_s));
  measure_position(&state_, h_s, repeated, sensor_.encoder_step_m, sensor_.position_noise_m);
  return estimate();
}

namespace {

constexpr std::size_t kWindowRows = 50;
constexpr double kQuietShare = 0.2;
// Below this a change is rounding of the last decimal, in any of the units.
constexpr double kFinestStep = 1e-9;
constexpr double kMultipleTolerance = 0.02;
// The tolerance grows with the multiple, like the error of the step, up to this limit: at most half of all noise passes
// as a multiple.
constexpr double kLargestMultipleTolerance = 0.25;
constexpr double kMultipleShare = 0.99;
// The readings of a moving encoder advance by varying numbers of steps: at most speeds half of the rows differ from the
// last. Readings that always advance by the same amount are a ramp of exact positions.
constexpr double kUnevenShare = 0.05;
// A difference of positions loses digits: at 1 m with steps of 1 um it keeps ten. Rounded to nine digits the step is
// the number of a data sheet, 3e-05 and not 2.9999999999998778e-05, and a program that is given that number computes
// the bits of replay.
constexpr int kStepDigits = 9;
// A step below this share of the noise is the last digit of the text, not a step of an encoder.
constexpr double kLeastStepOverNoise = 0.5;

// The quantisation step of a column; 0 if it is not quantised.
double quantisation_step(const RecordingRow* rows, std::size_t count, double RecordingRow::*column) {
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < count; ++i) {
    const double change = std::abs(rows[i].*column - rows[i - 1].*column);
    if (change > kFinestStep) step = std::min(step, change);
  }
  if (!std::isfinite(step)) return 0.0;
  std::size_t moved = 0, multiples = 0, uneven = 0;
  double last_steps = 0.0;
  for (std::size_t i = 1; i < count; ++i) {
    const double steps = std::abs(rows[i].*column - rows[i - 1].*column) / step;
    if (std::abs(steps - last_steps) > 0.5) ++uneven;
    last_steps = steps;
    if (steps < 0.5) continue;
    ++moved;
    const double tolerance = std::min(kMultipleTolerance * std::max(1.0, steps * 0.1), kLargestMultipleTolerance);
    if (std::abs(steps - std::round(steps)) < tolerance) ++multiples;
  }
  const bool quantised = static_cast<double>(multiples) >= kMultipleShare * static_cast<double>(moved);
  const bool is_ramp = static_cast<double>(uneven) < kUnevenShare * static_cast<double>(moved);
  return quantised && moved >= 3 && !is_ramp ? step : 0.0;
}

double quiet_noise(const RecordingRow* rows, std::size_t count, double RecordingRow::*column) {
  std::vector<double> window_variance;
  for (std::size_t begin = 0; begin + kWindowRows <= count; begin += kWindowRows) {
    double sum = 0.0;
    for (std::size_t i = begin + 2; i < begin + kWindowRows; ++i) {
      const double second = rows[i].*column - 2.0 * rows[i - 1].*column + rows[i - 2].*column;
      sum += second * second;
    }
    window_variance.push_back(sum / static_cast<double>(kWindowRows - 2));
  }
  if (window_variance.empty()) return 0.0;
  const auto quiet = static_cast<std::size_t>(kQuietShare * static_cast<double>(window_variance.size() - 1));
  return std::sqrt(nth_smallest(window_variance, quiet) / 6.0);
}

double rounded_step(double step) {
  if (!(step > 0.0)) return 0.0;
  const double per_step = std::pow(10.0, kStepDigits - 1 - static_cast<int>(std::floor(std::log10(step))));
  return std::round(step * per_step) / per_step;
}

// The nearest of 1, 2, 5, 10, ... by ratio; 0 stays 0.
double preferred_number(double value) {
  if (!(value > 0.0)) return 0.0;
  const double decade = std::floor(std::log10(value));
  double best = 0.0;
  for (const double digit : {1.0, 2.0, 5.0, 10.0}) {
    // A quotient of integers, so that equal numbers have equal bits.
    const double candidate = decade < 0.0 ? digit / std::pow(10.0, -decade) : digit * std::pow(10.0, decade);
    if (std::abs(std::log(candidate / value)) < std::abs(std::log(best / value))) best = candidate;
  }
  return best;
}

// The white noise of a column, at least that of its quantisation: a velocity that is a difference of encoder readings
// has no noise at rest and errors of a step in motion.
double column_noise(const RecordingRow* rows, std::size_t count, double RecordingRow::*column) {
  return std::max(quiet_noise(rows, count, column), quantisation_step(rows, count, column) / std::sqrt(12.0));
}

}  // namespace

SensorSpec identify_sensor(const RecordingRow* rows, std::size_t count, RecordingColumns columns) {
  count = std::min(count, kSensorIdentificationRows);
  SensorSpec sensor;
  sensor.encoder_step_m = rounded_step(quantisation_step(rows, count, &RecordingRow::position_m));
  const double position_noise_m = quiet_noise(rows, count, &RecordingRow::position_m);
  const double quantisation_m = sensor.encoder_step_m / std::sqrt(12.0);
  // Rounded by a factor of at most 1.6, which exceeds the difference between recordings of one rig and changes the
  // velocity less than half a decade of the density of the jerk.
  sensor.position_noise_m =
      preferred_number(std::sqrt(std::max(0.0, position_noise_m * position_noise_m - quantisation_m * quantisation_m)));
  if (sensor.encoder_step_m < kLeastStepOverNoise * sensor.position_noise_m) sensor.encoder_step_m = 0.0;
  sensor.has_velocity = columns.velocity;
  sensor.has_acceleration = columns.acceleration;
  // The floors are finer than any sensor, and a column of exact values leaves the estimator well conditioned.
  if (columns.velocity)
    sensor.velocity_noise_m_per_s = std::max(1e-4, column_noise(rows, count, &RecordingRow::velocity_m_per_s));
  if (columns.acceleration) {
    sensor.acceleration_noise_m_per_s2 =
        std::max(1e-2, column_noise(rows, count, &RecordingRow::acceleration_m_per_s2));
  }
  return sensor;
}

double identify_force_noise_N(const RecordingRow* rows, std::size_t count) {
  return quiet_noise(rows, std::min(count, kSensorIdentificationRows), &RecordingRow::force_N);
}

ToolSample tool_sample(const RecordingRow& row) noexcept {
  return {row.time_s, row.position_m, row.velocity_m_per_s, row.acceleration_m_per_s2};
}

}  // namespace palpate
