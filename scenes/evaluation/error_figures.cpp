#include "scenes/evaluation/error_figures.h"

#include <algorithm>
#include <cmath>

namespace palpate {

std::size_t force_bin(double force_N, const JndLine& jnd) noexcept {
  const double over_offset = std::max(0.0, force_N) / jnd.offset_N;
  const double jnds =
      jnd.weber_fraction > 0.0 ? std::log1p(jnd.weber_fraction * over_offset) / jnd.weber_fraction : over_offset;
  return static_cast<std::size_t>(std::min(jnds / kBinWidth_jnd, static_cast<double>(kMaximumForceBins - 1)));
}

double force_bin_begin_N(std::size_t index, const JndLine& jnd) noexcept {
  const double jnds = kBinWidth_jnd * static_cast<double>(index);
  return jnd.offset_N * (jnd.weber_fraction > 0.0 ? std::expm1(jnd.weber_fraction * jnds) / jnd.weber_fraction : jnds);
}

void Moments::add(double value) {
  const double change = value - mean_;
  mean_ += change / static_cast<double>(++count_);
  squares_ += change * (value - mean_);
  largest_ = std::max(largest_, value);
}

double Moments::deviation() const noexcept {
  return count_ > 0 ? std::sqrt(squares_ / static_cast<double>(count_)) : 0.0;
}

void ErrorFigures::add(double model_N, double reference_N, bool out_of_domain, const JndLine& jnd) {
  const double error_N = std::abs(model_N - reference_N);
  const double ratio = jnd.error_over_jnd(model_N, reference_N);
  ++sum_.samples;
  if (ratio <= 1.0) ++within_;
  if (out_of_domain) ++sum_.out_of_domain_samples;
  squares_N2_ += error_N * error_N;
  ratios_ += ratio;
  sum_.max_error_N = std::max(sum_.max_error_N, error_N);
  sum_.max_error_over_jnd = std::max(sum_.max_error_over_jnd, ratio);

  const std::size_t index = force_bin(reference_N, jnd);
  if (sum_.bins.size() <= index) sum_.bins.resize(index + 1);
  ForceBin& bin = sum_.bins[index];
  bin.force_N.add(reference_N);
  bin.error_N.add(error_N);
  bin.over_jnd.add(ratio);
  if (reference_N != 0.0) bin.relative.add(error_N / std::abs(reference_N));
}

ErrorSummary ErrorFigures::summary(const JndLine& jnd) const {
  ErrorSummary summary = sum_;
  summary.rms_error_N = std::sqrt(share(squares_N2_));
  summary.within_jnd = within_jnd();
  for (std::size_t i = 0; i < summary.bins.size(); ++i) {
    ForceBin& bin = summary.bins[i];
    bin.force_from_N = force_bin_begin_N(i, jnd);
    bin.force_to_N = force_bin_begin_N(i + 1, jnd);
    bin.jnd_N = jnd.at(0.5 * (bin.force_from_N + bin.force_to_N));
  }
  return summary;
}

}  // namespace palpate
