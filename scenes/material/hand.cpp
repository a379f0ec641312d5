#include "scenes/material/hand.h"

namespace palpate {

double Hand::held_depth_m(double force_N) const noexcept {
  double low_m = 0.0, high_m = 0.1;
  for (int i = 0; i < 40; ++i) {
    const double depth_m = 0.5 * (low_m + high_m);
    double held_N = material_.elastic_force_N(depth_m);
    for (std::size_t b = 0; b < material_.branch_count; ++b) {
      held_N += 0.5 * material_.unrelaxed_force_N(b, depth_m);
    }
    (held_N < force_N ? low_m : high_m) = depth_m;
  }
  return low_m;
}

}  // namespace palpate
