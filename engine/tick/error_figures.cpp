#include "engine/tick/error_figures.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

std::size_t bin_of(double reference_N) noexcept {
  const double bin = std::floor(std::max(0.0, reference_N) / kForceBin_N);
  return static_cast<std::size_t>(std::min(bin, static_cast<double>(kMaximumForceBins - 1)));
}

}  // namespace

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

  const std::size_t index = bin_of(reference_N);
  if (bins_.size() <= index) bins_.resize(index + 1);
  Moments& bin = bins_[index];
  ++bin.count;
  const double change = error_N - bin.mean;
  bin.mean += change / static_cast<double>(bin.count);
  bin.squares += change * (error_N - bin.mean);
  bin.largest = std::max(bin.largest, error_N);
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
    const Moments& moments = bins_[i];
    ForceBin bin;
    bin.force_from_N = static_cast<double>(i) * kForceBin_N;
    bin.force_to_N = static_cast<double>(i + 1) * kForceBin_N;
    bin.count = moments.count;
    bin.jnd_N = jnd.at(0.5 * (bin.force_from_N + bin.force_to_N));
    bin.mean_abs_error_N = moments.mean;
    bin.max_abs_error_N = moments.largest;
    if (moments.count > 0) bin.std_abs_error_N = std::sqrt(moments.squares / static_cast<double>(moments.count));
    bins.push_back(bin);
  }
  return bins;
}

}  // namespace palpate
