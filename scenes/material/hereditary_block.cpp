#include "scenes/material/hereditary_block.h"

namespace palpate {

void HereditaryBlock::prepare() noexcept {
  for (std::size_t i = 0; i < kTimes; ++i) memory_N_[i] += kick_[i] * settled_N_;
  settled_N_ = gain_ = 0.0;
  for (std::size_t i = 0; i < kTimes; ++i) {
    const double ratio = substep_s() / time_s_[i];
    decay_[i] = std::exp(-ratio);
    kick_[i] = weight_[i] * -std::expm1(-ratio) / ratio;
    gain_ += kick_[i];
  }
}

void HereditaryBlock::begin_substep() noexcept {
  // Four independent sums, so that no addition waits for the one before.
  constexpr std::size_t kLanes = 4;
  static_assert(kTimes % kLanes == 0);
  double sum_N[kLanes] = {};
  for (std::size_t i = 0; i < kTimes; i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double left_N = (memory_N_[i + lane] + kick_[i + lane] * settled_N_) * decay_[i + lane];
      memory_N_[i + lane] = std::abs(left_N) > kNoForce_N ? left_N : 0.0;
      sum_N[lane] += memory_N_[i + lane];
    }
  }
  settled_N_ = 0.0;
  relaxed_N_ = (sum_N[0] + sum_N[1]) + (sum_N[2] + sum_N[3]);
}

}  // namespace palpate
