#include "engine/tick/evaluation.h"

#include <algorithm>

namespace palpate {
namespace {

// The smallest value that at least 99 % of `values` do not exceed.
double percentile_99(std::vector<float> values) {
  const std::size_t rank = (values.size() * 99 + 99) / 100;  // rounded up, from 1
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(rank - 1);
  std::nth_element(values.begin(), nth, values.end());
  return static_cast<double>(*nth);
}

}  // namespace

void ErrorStatistics::add(double model_N, double measured_N, bool out_of_domain) {
  figures_.add(model_N, measured_N, out_of_domain, jnd_);
  ratios_.push_back(static_cast<float>(jnd_.error_over_jnd(model_N, measured_N)));
}

ErrorSummary ErrorStatistics::summary() const {
  ErrorSummary summary;
  summary.samples = figures_.samples();
  if (summary.samples == 0) return summary;
  summary.rms_error_N = figures_.rms_error_N();
  summary.max_error_N = figures_.max_error_N();
  summary.within_jnd = figures_.within_jnd();
  summary.p99_error_over_jnd = percentile_99(ratios_);
  summary.max_error_over_jnd = figures_.max_error_over_jnd();
  summary.out_of_domain_samples = figures_.out_of_domain_samples();
  summary.bins = figures_.bins(jnd_);
  return summary;
}

}  // namespace palpate
