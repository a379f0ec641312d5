#include "scenes/material/relaxation_spectrum.h"

#include <cmath>

namespace palpate {
namespace {

// Keeps a block that rests in free air from computing with denormal numbers.
constexpr double kSmallest_N = 1e-30;
// Sums in so many lanes that the additions need not wait for each other.
constexpr std::size_t kLanes = 4;
static_assert(RelaxationSpectrum::kTimes % kLanes == 0);

}  // namespace

double RelaxationSpectrum::spacing(double shortest_s, double longest_s) {
  return std::log(longest_s / shortest_s) / static_cast<double>(kTimes);
}

double RelaxationSpectrum::midpoint_s(double shortest_s, double longest_s, std::size_t index) {
  return shortest_s * std::exp(spacing(shortest_s, longest_s) * (static_cast<double>(index) + 0.5));
}

void RelaxationSpectrum::prepare(double substep_s) noexcept {
  for (std::size_t i = 0; i < kTimes; ++i) memory_N_[i] += kick_[i] * settled_N_;
  settled_N_ = gain_ = 0.0;
  for (std::size_t i = 0; i < kTimes; ++i) {
    const double ratio = substep_s / time_s_[i];
    decay_[i] = std::exp(-ratio);
    kick_[i] = weight_[i] * -std::expm1(-ratio) / ratio;
    gain_ += kick_[i];
  }
}

void RelaxationSpectrum::relax() noexcept {
  double sum_N[kLanes] = {};
  for (std::size_t i = 0; i < kTimes; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double left_N = (memory_N_[i + lane] + kick_[i + lane] * settled_N_) * decay_[i + lane];
      memory_N_[i + lane] = std::abs(left_N) > kSmallest_N ? left_N : 0.0;
      sum_N[lane] += memory_N_[i + lane];
    }
  }
  settled_N_ = 0.0;
  relaxed_N_ = (sum_N[0] + sum_N[1]) + (sum_N[2] + sum_N[3]);
}

void RelaxationSpectrum::settle(double change_N) noexcept { settled_N_ = change_N; }

void RelaxationSpectrum::forget() noexcept {
  memory_N_.fill(0.0);
  relaxed_N_ = settled_N_ = 0.0;
}

}  // namespace palpate
