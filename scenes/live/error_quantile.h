// The 99 % error of a stream in bounded memory: the smallest error over the JND that 99 % of the samples do not
// exceed (scenes/evaluation/model_errors.h). It is rounded up by at most 4.4 %, never across 1.
// Thread guarantee: value type; `add` allocates nothing.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace palpate {

class ErrorQuantile {
 public:
  void add(double error_over_jnd) noexcept {
    const double bin = kPerOctave * std::log2(std::max(error_over_jnd, 1e-9)) + kBelow;
    ++counts_[static_cast<std::size_t>(std::clamp(std::ceil(bin - 1e-9), 0.0, kBins - 1.0))];
    ++samples_;
  }
  // 0 without samples.
  double p99() const noexcept {
    std::uint64_t beyond = samples_ / 100;  // number of samples that may lie above
    for (std::size_t i = counts_.size(); i-- > 0;) {
      if (counts_[i] > beyond) return i == 0 ? 0.0 : std::exp2((static_cast<double>(i) - kBelow) / kPerOctave);
      beyond -= counts_[i];
    }
    return 0.0;
  }

 private:
  // Logarithmic bins from 1/1024 to 1024 JND; 1 is the edge of a bin.
  static constexpr double kPerOctave = 16.0;
  static constexpr double kBelow = 160.0;
  static constexpr double kBins = 321.0;
  std::array<std::uint32_t, 321> counts_{};
  std::uint64_t samples_ = 0;
};

}  // namespace palpate
