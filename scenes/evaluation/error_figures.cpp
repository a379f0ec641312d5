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

void ErrorFigures::Moments::add(double value, double count) {
  const double change = value - mean;
  mean += change / count;
  squares += change * (value - mean);
  largest = std::max(largest, value);
}

void ErrorFigures::Moments::add(const Moments& other, double count, double other_count) {
  const double change = other.mean - mean;
  const double all = count + other_count;
  mean += change * other_count / all;
  squares += other.squares + change * change * count * other_count / all;
  largest = std::max(largest, other.largest);
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
  Bin& bin = bins_[index];
  const auto count = static_cast<double>(++bin.count);
  bin.force_N += (reference_N - bin.force_N) / count;
  bin.error_N.add(error_N, count);
  bin.ratio.add(ratio, count);
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
    Bin& bin = bins_[i];
    const Bin& more = other.bins_[i];
    if (more.count == 0) continue;
    const auto count = static_cast<double>(bin.count);
    const auto more_count = static_cast<double>(more.count);
    bin.force_N += (more.force_N - bin.force_N) * more_count / (count + more_count);
    bin.error_N.add(more.error_N, count, more_count);
    bin.ratio.add(more.ratio, count, more_count);
    bin.count += more.count;
  }
}

double ErrorFigures::within_jnd() const noexcept {
  return samples_ > 0 ? static_cast<double>(within_) / static_cast<double>(samples_) : 0.0;
}

double ErrorFigures::mean_error_over_jnd() const noexcept {
  return samples_ > 0 ? ratios_ / static_cast<double>(samples_) : 0.0;
}

double ErrorFigures::rms_error_N() const noexcept {
  return samples_ > 0 ? std::sqrt(squares_N2_ / static_cast<double>(samples_)) : 0.0;
}

std::vector<ForceBin> ErrorFigures::bins(const JndLine& jnd) const {
  std::vector<ForceBin> bins;
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    const Bin& held = bins_[i];
    ForceBin bin;
    bin.force_from_N = force_bin_begin_N(i, jnd);
    bin.force_to_N = force_bin_begin_N(i + 1, jnd);
    bin.jnd_N = jnd.at(0.5 * (bin.force_from_N + bin.force_to_N));
    bin.count = held.count;
    bin.mean_force_N = held.force_N;
    bin.mean_abs_error_N = held.error_N.mean;
    bin.max_abs_error_N = held.error_N.largest;
    bin.mean_error_over_jnd = held.ratio.mean;
    bin.max_error_over_jnd = held.ratio.largest;
    if (held.count > 0) {
      bin.std_abs_error_N = std::sqrt(held.error_N.squares / static_cast<double>(held.count));
      bin.std_error_over_jnd = std::sqrt(held.ratio.squares / static_cast<double>(held.count));
    }
    bins.push_back(bin);
  }
  return bins;
}

}  // namespace palpate
