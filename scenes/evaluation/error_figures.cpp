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

void Moments::add(const Moments& other) {
  if (other.count_ == 0) return;
  const double change = other.mean_ - mean_;
  const auto count = static_cast<double>(count_);
  const auto other_count = static_cast<double>(other.count_);
  const double all = count + other_count;
  count_ += other.count_;
  mean_ += change * other_count / all;
  squares_ += other.squares_ + change * change * count * other_count / all;
  largest_ = std::max(largest_, other.largest_);
}

double Moments::deviation() const noexcept {
  return count_ > 0 ? std::sqrt(squares_ / static_cast<double>(count_)) : 0.0;
}

void ErrorFigures::add(double model_N, double reference_N, bool out_of_domain, const JndLine& jnd) {
  const double error_N = std::abs(model_N - reference_N);
  const double ratio = jnd.error_over_jnd(model_N, reference_N);
  ++samples_;
  if (ratio <= 1.0) ++within_;
  if (out_of_domain) ++out_of_domain_;
  squares_N2_ += error_N * error_N;
  max_error_N_ = std::max(max_error_N_, error_N);
  ratios_ += ratio;
  max_ratio_ = std::max(max_ratio_, ratio);

  const std::size_t index = force_bin(reference_N, jnd);
  if (bins_.size() <= index) bins_.resize(index + 1);
  ForceBin& bin = bins_[index];
  bin.force_N.add(reference_N);
  bin.error_N.add(error_N);
  bin.over_jnd.add(ratio);
}

void ErrorFigures::add(const ErrorFigures& other) {
  samples_ += other.samples_;
  within_ += other.within_;
  out_of_domain_ += other.out_of_domain_;
  squares_N2_ += other.squares_N2_;
  max_error_N_ = std::max(max_error_N_, other.max_error_N_);
  ratios_ += other.ratios_;
  max_ratio_ = std::max(max_ratio_, other.max_ratio_);
  if (bins_.size() < other.bins_.size()) bins_.resize(other.bins_.size());
  for (std::size_t i = 0; i < other.bins_.size(); ++i) {
    bins_[i].force_N.add(other.bins_[i].force_N);
    bins_[i].error_N.add(other.bins_[i].error_N);
    bins_[i].over_jnd.add(other.bins_[i].over_jnd);
  }
}

double ErrorFigures::within_jnd() const noexcept {
  return samples_ > 0 ? static_cast<double>(within_) / static_cast<double>(samples_) : 0.0;
}

double ErrorFigures::mean_error_over_jnd() const noexcept {
  return samples_ > 0 ? ratios_ / static_cast<double>(samples_) : 0.0;
}

ErrorSummary ErrorFigures::summary(const JndLine& jnd) const {
  ErrorSummary summary;
  if (samples_ == 0) return summary;
  summary.samples = samples_;
  summary.rms_error_N = std::sqrt(squares_N2_ / static_cast<double>(samples_));
  summary.max_error_N = max_error_N_;
  summary.within_jnd = within_jnd();
  summary.max_error_over_jnd = max_ratio_;
  summary.out_of_domain_samples = out_of_domain_;
  summary.bins = bins_;
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    ForceBin& bin = summary.bins[i];
    bin.force_from_N = force_bin_begin_N(i, jnd);
    bin.force_to_N = force_bin_begin_N(i + 1, jnd);
    bin.jnd_N = jnd.at(0.5 * (bin.force_from_N + bin.force_to_N));
  }
  return summary;
}

}  // namespace palpate
