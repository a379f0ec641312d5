#include "scenes/evaluation/model_errors.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

constexpr double kOneSided = 0.05;  // probability beyond a one-sided bound; beyond each end of an interval: half

// The value of this rank, from 0 in ascending order.
double ranked(std::vector<float> values, std::size_t rank) {
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), nth, values.end());
  return static_cast<double>(*nth);
}

// P(|T| <= t) of Student's t distribution. Source: Abramowitz & Stegun (1972), 26.7.3 and 26.7.4.
double central_probability(double t, std::size_t degrees) {
  const double angle = std::atan(t / std::sqrt(static_cast<double>(degrees)));
  const double cosine = std::cos(angle);
  const bool odd = degrees % 2 == 1;
  double term = odd ? cosine : 1.0;
  double sum = degrees > 1 ? term : 0.0;
  for (std::size_t k = odd ? 3 : 2; k + 2 <= degrees; k += 2) {
    term *= cosine * cosine * static_cast<double>(k - 1) / static_cast<double>(k);
    sum += term;
  }
  return odd ? 2.0 / std::numbers::pi * (angle + std::sin(angle) * sum) : std::sin(angle) * sum;
}

// The value that Student's t exceeds with the probability `above`, 0 to 0.5. With more than 200 degrees of freedom it
// is that of 200, which is larger by less than 0.7 %: the sum above stays short.
double student_t(double above, std::size_t degrees) {
  double low = 0.0, high = 1e6;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (central_probability(middle, std::min<std::size_t>(degrees, 200)) < 1.0 - 2.0 * above ? low : high) = middle;
  }
  return high;
}

// Standard error of sum(numerators) / sum(denominators), with one of each per unit; at least two units.
double ratio_standard_error(const std::vector<double>& numerators, const std::vector<double>& denominators) {
  const std::size_t n = numerators.size();
  const double whole = std::accumulate(denominators.begin(), denominators.end(), 0.0);
  const double ratio = std::accumulate(numerators.begin(), numerators.end(), 0.0) / whole;
  double squares = 0.0;
  for (std::size_t i = 0; i < n; ++i) squares += std::pow(numerators[i] - ratio * denominators[i], 2);
  const auto count = static_cast<double>(n);
  return std::sqrt(count / (count - 1.0) * squares) / whole;
}

// The 99 % error of every draw of units. `bounds`: the first sample of each unit in `ratios`, then their number.
std::vector<float> resample(const std::vector<float>& ratios, const std::vector<std::size_t>& bounds) {
  const std::size_t units = bounds.size() - 1;
  if (units < kLeastUnits) return {};
  std::vector<std::pair<float, std::size_t>> samples;  // error and unit, in descending order
  for (std::size_t unit = 0; unit < units; ++unit) {
    for (std::size_t i = bounds[unit]; i < bounds[unit + 1]; ++i) samples.emplace_back(ratios[i], unit);
  }
  std::ranges::sort(samples, std::ranges::greater{}, &std::pair<float, std::size_t>::first);
  RandomStream random(1, 0);
  std::vector<float> errors;
  for (std::size_t draw = 0; draw < kResamples; ++draw) {
    std::vector<std::size_t> times(units, 0);
    std::size_t drawn = 0;  // samples
    for (std::size_t k = 0; k < units; ++k) {
      const auto unit = static_cast<std::size_t>(random.index(units));
      ++times[unit];
      drawn += bounds[unit + 1] - bounds[unit];
    }
    const std::size_t beyond = drawn / 100;  // number of samples that may exceed the 99 % error
    std::size_t count = 0;
    auto one = samples.begin();
    while ((count += times[one->second]) <= beyond) ++one;
    errors.push_back(one->first);
  }
  return errors;
}

// The expanded percentile interval of a bootstrap with this number of units.
Interval interval_95(std::vector<float> resampled, std::size_t units) {
  if (resampled.empty()) return {kUnknown, kUnknown};
  const auto n = static_cast<double>(units);
  const double below =
      0.5 * std::erfc(std::sqrt(n / (n - 1.0)) * student_t(0.5 * kOneSided, units - 1) / std::numbers::sqrt2);
  const auto rank = static_cast<std::size_t>(below * static_cast<double>(resampled.size()));
  std::ranges::sort(resampled);
  return {static_cast<double>(resampled[rank]), static_cast<double>(resampled[resampled.size() - 1 - rank])};
}

}  // namespace

Interval UnitErrors::p99_interval() const { return interval_95(resampled_p99, units()); }

double UnitErrors::within_at_least() const {
  if (!has_intervals()) return kUnknown;
  if (units_above_jnd == 0) return std::pow(kOneSided, 1.0 / static_cast<double>(units()));
  return std::max(0.0,
                  within_jnd - student_t(kOneSided, units() - 1) * ratio_standard_error(unit_within, unit_samples));
}

PairedDifference paired_difference(const UnitErrors& one, const UnitErrors& other) {
  std::vector<float> differences;
  for (std::size_t i = 0; i < std::min(one.resampled_p99.size(), other.resampled_p99.size()); ++i)
    differences.push_back(one.resampled_p99[i] - other.resampled_p99[i]);
  return {one.p99_error_over_jnd - other.p99_error_over_jnd, interval_95(std::move(differences), one.units())};
}

bool StrokeCounter::begins_stroke(double time_s, bool in_contact) {
  if (!in_contact) {
    in_air_ = true;
    return false;
  }
  const bool begins = in_air_ && time_s - last_contact_s_ > kStrokePause_s;
  in_air_ = false;
  last_contact_s_ = time_s;
  return begins;
}

void ModelErrors::add(double model_N, double measured_N, bool out_of_domain, double bound_N) {
  if (strokes_.empty()) begin_stroke();
  figures_.add(model_N, measured_N, out_of_domain, jnd_);
  ratios_.push_back(static_cast<float>(jnd_.error_over_jnd(model_N, measured_N)));
  if (std::isnan(bound_N)) return;
  bounds_N_.push_back(static_cast<float>(bound_N));
  bounds_over_jnd_.push_back(static_cast<float>(bound_N / jnd_.at(measured_N)));
  if (std::abs(model_N - measured_N) <= bound_N) ++covered_;
  largest_force_N_ = std::max(largest_force_N_, std::abs(measured_N));
}

ErrorSummary ModelErrors::summary() const {
  ErrorSummary summary = figures_.summary(jnd_);
  if (summary.samples > 0) summary.p99_error_over_jnd = ranked(ratios_, (ratios_.size() * 99 + 99) / 100 - 1);
  return summary;
}

UnitErrors ModelErrors::unit_errors() const {
  UnitErrors unit_errors;
  static_cast<ErrorSummary&>(unit_errors) = summary();
  // The first sample of each unit, and their number. A recording without contact has no samples, as has a stroke that
  // ended before the counted time.
  const auto bounds_of = [&](std::vector<std::size_t> bounds) {
    bounds.push_back(ratios_.size());
    bounds.erase(std::unique(bounds.begin(), bounds.end()), bounds.end());
    return bounds;
  };
  std::vector<std::size_t> bounds = bounds_of(recordings_);
  unit_errors.units_are_recordings = bounds.size() > 2;
  if (!unit_errors.units_are_recordings) bounds = bounds_of(strokes_);
  for (std::size_t i = 0; i + 1 < bounds.size(); ++i) {
    const auto begin = ratios_.begin() + static_cast<std::ptrdiff_t>(bounds[i]);
    const auto end = ratios_.begin() + static_cast<std::ptrdiff_t>(bounds[i + 1]);
    const auto within = std::count_if(begin, end, [](float ratio) { return ratio <= 1.0F; });
    unit_errors.unit_samples.push_back(static_cast<double>(end - begin));
    unit_errors.unit_within.push_back(static_cast<double>(within));
    unit_errors.units_above_jnd += within < end - begin ? 1 : 0;
  }
  unit_errors.resampled_p99 = resample(ratios_, bounds);
  return unit_errors;
}

BoundFigures ModelErrors::bounds() const {
  // Outside its surface a model returns 0 N with certainty, whether it has a bound or not.
  if (std::ranges::none_of(bounds_N_, [](float bound_N) { return bound_N > 0.0F; })) return {};
  const std::size_t middle = bounds_N_.size() / 2;
  const double median_N = ranked(bounds_N_, middle);
  return {static_cast<double>(covered_) / static_cast<double>(bounds_N_.size()), median_N,
          median_N <= largest_force_N_ ? ranked(bounds_over_jnd_, middle) : kUnknown};
}

}  // namespace palpate
