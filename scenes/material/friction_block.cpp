#include "scenes/material/friction_block.h"

#include <algorithm>
#include <cmath>

namespace palpate {

FrictionBlock::FrictionBlock() : spectrum_(0.05, 2.0, [](double) { return kWeight; }) {}

double FrictionBlock::held_force_N(double depth_m) const noexcept {
  return kContact.force_N(depth_m) * (1.0 + 0.5 * spectrum_.total_weight());
}

std::string FrictionBlock::relaxation_times_text() const { return "continuous, 0.05 s to 2 s; dry friction"; }

double FrictionBlock::friction_limit_N(double depth_m) noexcept {
  return kFriction_N * std::min(1.0, depth_m / kGripped_m);
}

// F_c(s) z when the probe goes on to `surface_m`, exact for each bristle.
double FrictionBlock::friction_after_N(double surface_m) const noexcept {
  const double way_m = surface_m - last_surface_m();
  const double side = way_m < 0.0 ? -1.0 : 1.0;
  const double slipped = -std::expm1(-std::abs(way_m) / kPresliding_m);
  const double bend = bend_ + (side - bend_) * slipped;
  // Those that arrive in this sub-step are unbent when they do.
  return bend * friction_limit_N(std::min(surface_m, last_surface_m()));
}

double FrictionBlock::free_force_N(double surface_m, double) const noexcept {
  const double elastic_N = kContact.force_N(surface_m);
  return elastic_N + spectrum_.memory_N(elastic_N - elastic_N_);
}

double FrictionBlock::contact_force_N(double surface_m, double rate_m_per_s) const noexcept {
  return free_force_N(surface_m, rate_m_per_s) + friction_after_N(surface_m);
}

void FrictionBlock::settle(double surface_m, bool touching) noexcept {
  const double limit_N = friction_limit_N(surface_m);
  const double pushing_N = free_force_N(surface_m, 0.0);
  const double friction_N = std::max(friction_after_N(surface_m), -pushing_N);
  bend_ = touching && limit_N > kNoForce_N ? std::clamp(friction_N / limit_N, -1.0, 1.0) : 0.0;
  const double elastic_N = kContact.force_N(surface_m);
  spectrum_.settle(elastic_N - elastic_N_);
  elastic_N_ = elastic_N;
}

void FrictionBlock::forget(double surface_m) noexcept {
  spectrum_.forget();
  elastic_N_ = kContact.force_N(surface_m);
  bend_ = 0.0;
}

}  // namespace palpate
