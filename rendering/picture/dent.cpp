#include "rendering/picture/dent.h"

#include <algorithm>
#include <cmath>

namespace palpate {

DentShape dent_under_ball(float depth_m, float radius_m) noexcept {
  DentShape dent;
  if (!(depth_m > 0.0F)) return dent;
  const float below = depth_m - radius_m;
  const float q = (std::sqrt(below * below + 3.0F * radius_m * radius_m) - below) / 3.0F;
  dent.depth_m = depth_m;
  dent.contact_m = std::max(dent.contact_m, std::sqrt(std::max(0.0F, radius_m * radius_m - q * q)));
  dent.edge_m = below + q;
  return dent;
}

}  // namespace palpate
