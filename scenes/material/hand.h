// The simulated hand (devices/virtual/hand_motion.h) that presses a known virtual material: it converts a target
// force to a depth by Block::half_relaxed_force_N.
// Thread guarantee: as HandMotion.
#pragma once

#include <cstdint>
#include <memory>

#include "devices/virtual/hand_motion.h"
#include "scenes/material/material.h"

namespace palpate {

class Hand final : public HandMotion {
 public:
  Hand(const Material& material, const HandSettings& settings, std::uint64_t seed)
      : HandMotion(settings, seed), block_(material.make_block()) {}

 protected:
  double held_depth_m(double force_N) const noexcept override {
    double low_m = 0.0, high_m = 0.1;
    for (int i = 0; i < 40; ++i) {
      const double depth_m = 0.5 * (low_m + high_m);
      (block_->half_relaxed_force_N(depth_m) < force_N ? low_m : high_m) = depth_m;
    }
    return low_m;
  }

 private:
  std::unique_ptr<const Block> block_;  // for half_relaxed_force_N only
};

}  // namespace palpate
