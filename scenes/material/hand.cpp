#include "scenes/material/hand.h"

namespace palpate {

double Hand::held_depth_m(double force_N) const noexcept {
  double low_m = 0.0, high_m = 0.1;
  for (int i = 0; i < 40; ++i) {
    const double depth_m = 0.5 * (low_m + high_m);
    (block_->held_force_N(depth_m) < force_N ? low_m : high_m) = depth_m;
  }
  return low_m;
}

}  // namespace palpate
