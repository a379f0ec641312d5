// The simulated hand (devices/virtual/hand_motion.h) that presses a virtual material,
// which it knows: it aims at the depth that holds a force, the branches half
// relaxed.
// Thread guarantee: as HandMotion.
#pragma once

#include <cstdint>
#include <memory>

#include "devices/virtual/hand_motion.h"
#include "scenes/material/material.h"

namespace palpate {

class Hand final : public HandMotion {
 public:
  // `material`: what it presses, to aim by force.
  Hand(const Material& material, const HandSettings& settings, std::uint64_t seed)
      : HandMotion(settings, seed), block_(material.make_block()) {}

 protected:
  double held_depth_m(double force_N) const noexcept override;

 private:
  std::unique_ptr<const Block> block_;  // untouched, for what it would hold
};

}  // namespace palpate
