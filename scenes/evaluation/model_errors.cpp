#include "scenes/evaluation/model_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace palpate {
namespace {

constexpr double kOneSided = 0.05;  // probability beyond a one-sided bound; beyond each end of an interval: half

// The smallest of the values from `begin` to `end` that at least 99 % of them do not exceed.
double percentile_99(std::vector<float>::const_iterator begin, std::vector<float>::const_iterator end) {
  std::vector<float> values(begin, end);
  const std::size_t rank = (values.size() * 99 + 99) / 100;  // rounded up, from 1
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(rank - 1);
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

// With more degrees of freedom Student's t is that of kMostDegrees, which is larger by less than 0.7 %: its bounds are
// slightly too wide, and the sum above stays short.
constexpr std::size_t kMostDegrees = 200;

// The values that Student's t exceeds with the probability `above`, 0 to 0.5, by its degrees of freedom. Each is
// computed once, because a window compares all models in every frame.
class StudentT {
 public:
  explicit StudentT(double above) {
    for (std::size_t degrees = 1; degrees <= kMostDegrees; ++degrees) {
      double low = 0.0;
      double& high = values_[degrees] = 1e6;
      for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (central_probability(middle, degrees) < 1.0 - 2.0 * above ? low : high) = middle;
      }
    }
  }
  double at(std::size_t degrees) const { return values_[std::min(degrees, kMostDegrees)]; }

 private:
  std::array<double, kMostDegrees + 1> values_{};
};

// Standard error of sum(numerators) / sum(denominators), with one of each per unit; NaN with fewer than kLeastUnits.
double ratio_standard_error(const std::vector<double>& numerators, const std::vector<double>& denominators) {
  const std::size_t n = numerators.size();
  if (n < kLeastUnits) return kUnknown;
  const double whole = std::accumulate(denominators.begin(), denominators.end(), 0.0);
  const double ratio = std::accumulate(numerators.begin(), numerators.end(), 0.0) / whole;
  double squares = 0.0;
  for (std::size_t i = 0; i < n; ++i) squares += std::pow(numerators[i] - ratio * denominators[i], 2);
  const auto count = static_cast<double>(n);
  return std::sqrt(count / (count - 1.0) * squares) / whole;
}

// Standard error of the mean of `values`.
double standard_error(const std::vector<double>& values) {
  return ratio_standard_error(values, std::vector<double>(values.size(), 1.0));
}

// One-sided 95 % bound: estimate + t error; a negative error gives the lower bound. NaN with fewer than kLeastUnits.
double bound(double estimate, double error, std::size_t units) {
  static const StudentT one_sided(kOneSided);
  return units < kLeastUnits ? kUnknown : estimate + one_sided.at(units - 1) * error;
}

Interval interval_95(double estimate, double error, std::size_t units) {
  static const StudentT two_sided(0.5 * kOneSided);
  if (units < kLeastUnits) return {kUnknown, kUnknown};
  const double width = two_sided.at(units - 1) * error;
  return {estimate - width, estimate + width};
}

}  // namespace

Interval UnitErrors::p99_interval() const {
  Interval interval = interval_95(p99_error_over_jnd, standard_error(unit_p99), units());
  interval.low = std::max(interval.low, 0.0);  // keeps a NaN
  return interval;
}

double UnitErrors::p99_at_most() const { return bound(p99_error_over_jnd, standard_error(unit_p99), units()); }

double UnitErrors::within_at_least() const {
  if (has_intervals() && units_above_jnd == 0) return std::pow(kOneSided, 1.0 / static_cast<double>(units()));
  return std::max(bound(within_jnd, -ratio_standard_error(unit_within, unit_samples), units()), 0.0);
}

PairedDifference paired_difference(const UnitErrors& one, const UnitErrors& other) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < std::min(one.unit_p99.size(), other.unit_p99.size()); ++i)
    differences.push_back(one.unit_p99[i] - other.unit_p99[i]);
  const double error = standard_error(differences);
  const double difference = one.p99_error_over_jnd - other.p99_error_over_jnd;
  return {difference, interval_95(difference, error, differences.size()), bound(difference, error, differences.size())};
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

void ModelErrors::add(double model_N, double measured_N, bool out_of_domain) {
  if (recordings_.empty()) recordings_.push_back(0);
  if (strokes_.empty()) begin_stroke();
  figures_.add(model_N, measured_N, out_of_domain, jnd_);
  ratios_.push_back(static_cast<float>(jnd_.error_over_jnd(model_N, measured_N)));
}

void ModelErrors::append(const ModelErrors& other) {
  const std::size_t before = ratios_.size();
  figures_.add(other.figures_);
  for (const std::size_t first : other.strokes_) strokes_.push_back(before + first);
  for (const std::size_t first : other.recordings_) recordings_.push_back(before + first);
  ratios_.insert(ratios_.end(), other.ratios_.begin(), other.ratios_.end());
}

ErrorSummary ModelErrors::summary() const {
  ErrorSummary summary = figures_.summary(jnd_);
  if (summary.samples > 0) summary.p99_error_over_jnd = percentile_99(ratios_.begin(), ratios_.end());
  return summary;
}

UnitErrors ModelErrors::unit_errors() const {
  UnitErrors unit_errors;
  static_cast<ErrorSummary&>(unit_errors) = summary();
  unit_errors.units_are_recordings = recordings_.size() > 1;
  std::vector<std::size_t> bounds = unit_errors.units_are_recordings ? recordings_ : strokes_;
  bounds.push_back(ratios_.size());
  for (std::size_t i = 0; i + 1 < bounds.size(); ++i) {
    if (bounds[i] == bounds[i + 1]) continue;  // a stroke that ended before the counted time
    const auto begin = ratios_.begin() + static_cast<std::ptrdiff_t>(bounds[i]);
    const auto end = ratios_.begin() + static_cast<std::ptrdiff_t>(bounds[i + 1]);
    const auto within = std::count_if(begin, end, [](float ratio) { return ratio <= 1.0F; });
    unit_errors.unit_samples.push_back(static_cast<double>(end - begin));
    unit_errors.unit_within.push_back(static_cast<double>(within));
    unit_errors.unit_p99.push_back(percentile_99(begin, end));
    unit_errors.units_above_jnd += within < end - begin ? 1 : 0;
  }
  return unit_errors;
}

}  // namespace palpate
