#include "scenes/report/data/binned_errors.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// So that the first of kForceBins is a tenth of an even one: (q - 1) / (q^16 - 1) = 1 / 160.
constexpr double kGrowth = 1.266;

// Mean and sum of squares around it, one value more. Source: Welford (1962).
void add_to(double value, double count, double& mean, double& squares) {
  const double change = value - mean;
  mean += change / count;
  squares += change * (value - mean);
}

}  // namespace

BinnedErrors::BinnedErrors(const JndLine& jnd, double largest_force_N) : jnd_(jnd) {
  const double largest_N = std::max(largest_force_N, 1e-6);
  double width_N = largest_N * (kGrowth - 1.0) / (std::pow(kGrowth, static_cast<double>(kForceBins)) - 1.0);
  double from_N = 0.0;
  for (std::size_t i = 0; i < kForceBins; ++i, width_N *= kGrowth) {
    ErrorBin bin;
    bin.force_from_N = from_N;
    bin.force_to_N = i + 1 == kForceBins ? largest_N : from_N + width_N;
    from_N = bin.force_to_N;
    bins_.push_back(bin);
  }
}

void BinnedErrors::add(double model_N, double measured_N) {
  auto at = std::upper_bound(bins_.begin(), bins_.end(), measured_N,
                             [](double force_N, const ErrorBin& bin) { return force_N < bin.force_to_N; });
  ErrorBin& bin = at == bins_.end() ? bins_.back() : *at;
  const double error_N = std::abs(model_N - measured_N);
  const double ratio = jnd_.error_over_jnd(model_N, measured_N);
  const auto count = static_cast<double>(++bin.count);
  bin.mean_force_N += (measured_N - bin.mean_force_N) / count;
  add_to(error_N, count, bin.mean_abs_error_N, bin.std_abs_error_N);
  add_to(ratio, count, bin.mean_error_over_jnd, bin.std_error_over_jnd);
  bin.max_abs_error_N = std::max(bin.max_abs_error_N, error_N);
  bin.max_error_over_jnd = std::max(bin.max_error_over_jnd, ratio);
}

std::vector<ErrorBin> BinnedErrors::bins() const {
  std::vector<ErrorBin> filled;
  for (ErrorBin bin : bins_) {
    if (bin.count == 0) continue;
    bin.std_abs_error_N = std::sqrt(bin.std_abs_error_N / static_cast<double>(bin.count));
    bin.std_error_over_jnd = std::sqrt(bin.std_error_over_jnd / static_cast<double>(bin.count));
    filled.push_back(bin);
  }
  return filled;
}

}  // namespace palpate
