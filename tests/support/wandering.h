// A smooth irregular motion in and out of a surface, 0 at time 0.
#pragma once

#include <cmath>
#include <cstdint>

#include "engine/base/random_stream.h"
#include "scenes/material/material.h"

namespace palpate::test {

struct Wandering {
  Wandering(std::uint64_t seed, double deepest_m) {
    RandomStream random(seed, 7);
    for (int i = 0; i < 4; ++i) {
      amplitude_m[i] = deepest_m * random.uniform(0.1, 0.4);
      rate_rad_per_s[i] = 6.28 * random.uniform(0.2, i == 3 ? 12.0 : 4.0);
    }
  }
  double position_m(double t) const {
    double sum = 0.0;
    for (int i = 0; i < 4; ++i) sum += amplitude_m[i] * std::sin(rate_rad_per_s[i] * t);
    return sum;
  }
  double velocity_m_per_s(double t) const {
    double sum = 0.0;
    for (int i = 0; i < 4; ++i) {
      sum += amplitude_m[i] * rate_rad_per_s[i] * std::cos(rate_rad_per_s[i] * t);
    }
    return sum;
  }
  double amplitude_m[4];
  double rate_rad_per_s[4];
};

// The depth at which the force of `block` is about 5 N.
inline double depth_of_5_N(const Block& block) {
  double depth_m = 0.0;
  while (block.half_relaxed_force_N(depth_m) < 5.0) depth_m += 1e-4;
  return depth_m;
}

}  // namespace palpate::test
