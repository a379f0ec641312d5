#include "models/evaluation.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

std::size_t bin_of(double measured_N) noexcept {
  const double bin = std::floor(std::max(0.0, measured_N) / kForceBin_N);
  return static_cast<std::size_t>(std::min(bin, static_cast<double>(kMaximumForceBins - 1)));
}

// The smallest value that at least 99 % of `values` do not exceed.
double percentile_99(std::vector<float> values) {
  const std::size_t rank = (values.size() * 99 + 99) / 100;  // rounded up, from 1
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(rank - 1);
  std::nth_element(values.begin(), nth, values.end());
  return static_cast<double>(*nth);
}

}  // namespace

void ErrorStatistics::add(double model_N, double measured_N, bool out_of_domain) {
  const double error_N = std::abs(model_N - measured_N);
  const double ratio = jnd_.error_over_jnd(model_N, measured_N);
  ++samples_;
  if (ratio <= 1.0) ++within_;
  if (out_of_domain) ++out_of_domain_;
  squares_N2_ += error_N * error_N;
  max_error_N_ = std::max(max_error_N_, error_N);
  max_ratio_ = std::max(max_ratio_, ratio);
  ratios_.push_back(static_cast<float>(ratio));

  const std::size_t index = bin_of(measured_N);
  if (bins_.size() <= index) bins_.resize(index + 1);
  Moments& bin = bins_[index];
  ++bin.count;
  const double change = error_N - bin.mean;
  bin.mean += change / static_cast<double>(bin.count);
  bin.squares += change * (error_N - bin.mean);
  bin.largest = std::max(bin.largest, error_N);
}

std::vector<ForceBin> ErrorStatistics::force_bins() const {
  std::vector<ForceBin> bins;
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    const Moments& moments = bins_[i];
    ForceBin bin;
    bin.force_from_N = static_cast<double>(i) * kForceBin_N;
    bin.force_to_N = static_cast<double>(i + 1) * kForceBin_N;
    bin.count = moments.count;
    bin.jnd_N = jnd_.at(0.5 * (bin.force_from_N + bin.force_to_N));
    bin.mean_abs_error_N = moments.mean;
    bin.max_abs_error_N = moments.largest;
    if (moments.count > 0) bin.std_abs_error_N = std::sqrt(moments.squares / static_cast<double>(moments.count));
    bins.push_back(bin);
  }
  return bins;
}

ErrorSummary ErrorStatistics::summary() const {
  ErrorSummary summary;
  summary.samples = samples_;
  if (samples_ == 0) return summary;
  const auto count = static_cast<double>(samples_);
  summary.rms_error_N = std::sqrt(squares_N2_ / count);
  summary.max_error_N = max_error_N_;
  summary.within_jnd = static_cast<double>(within_) / count;
  summary.p99_error_over_jnd = percentile_99(ratios_);
  summary.max_error_over_jnd = max_ratio_;
  summary.out_of_domain_samples = out_of_domain_;
  summary.bins = force_bins();
  return summary;
}

}  // namespace palpate
