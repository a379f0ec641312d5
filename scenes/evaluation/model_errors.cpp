#include "scenes/evaluation/model_errors.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double kOneSided = 0.05;

// The smallest of the values from `begin` to `end` that at least 99 % of them do not exceed.
double percentile_99(std::vector<float>::const_iterator begin, std::vector<float>::const_iterator end) {
  std::vector<float> values(begin, end);
  const std::size_t rank = (values.size() * 99 + 99) / 100;  // rounded up, from 1
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(rank - 1);
  std::nth_element(values.begin(), nth, values.end());
  return static_cast<double>(*nth);
}

}  // namespace

Interval UnitErrors::p99_interval() const {
  Interval interval = interval_95(p99_error_over_jnd, standard_error(unit_p99), units());
  interval.low = interval.known() ? std::max(0.0, interval.low) : interval.low;
  return interval;
}

double UnitErrors::p99_at_most() const { return bound_95(p99_error_over_jnd, standard_error(unit_p99), units()); }

double UnitErrors::within_at_least() const {
  if (!has_intervals()) return kUnknown;
  if (units_above_jnd == 0) return std::pow(kOneSided, 1.0 / static_cast<double>(units()));
  const double error = ratio_standard_error(unit_within, unit_samples);
  return std::max(0.0, bound_95(within_jnd, -error, units()));
}

PairedDifference paired_difference(const UnitErrors& one, const UnitErrors& other) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < std::min(one.unit_p99.size(), other.unit_p99.size()); ++i)
    differences.push_back(one.unit_p99[i] - other.unit_p99[i]);
  const double error = standard_error(differences);
  const double difference = one.p99_error_over_jnd - other.p99_error_over_jnd;
  return {difference, interval_95(difference, error, differences.size()),
          bound_95(difference, error, differences.size())};
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
