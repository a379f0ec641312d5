#include "scenes/material/softening_block.h"

#include <cmath>

namespace palpate {
namespace {

double stiffened(double depth_m) {
  const double share = depth_m / SofteningBlock::kStiffening_m;
  return share * share;
}

double elastic_force_N(double depth_m) {
  return SofteningBlock::kStiffness_N_per_m1_5 * depth_m * std::sqrt(depth_m) * (1.0 + stiffened(depth_m));
}

double elastic_energy_J(double depth_m) {
  return SofteningBlock::kStiffness_N_per_m1_5 * depth_m * depth_m * std::sqrt(depth_m) *
         (2.0 / 5.0 + 2.0 / 9.0 * stiffened(depth_m));
}

}  // namespace

SofteningBlock::SofteningBlock() : spectrum_(0.01, 3.0, [](double) { return kWeight; }) {}

double SofteningBlock::held_force_N(double depth_m) const noexcept {
  return elastic_force_N(depth_m) * (1.0 + 0.5 * spectrum_.total_weight());
}

double SofteningBlock::relaxed_force_N(double depth_m) const noexcept { return elastic_force_N(depth_m); }

std::string SofteningBlock::relaxation_times_text() const { return "continuous, 0.01 s to 3 s; heals in 6 s"; }

void SofteningBlock::prepare() noexcept {
  spectrum_.prepare(substep_s());
  fade_ = std::exp(-substep_s() / kHealing_s);
}

void SofteningBlock::begin_substep() noexcept {
  spectrum_.relax();
  deepest_m_ = last_surface_m() + (deepest_m_ - last_surface_m()) * fade_;
  if (deepest_m_ < 1e-12) deepest_m_ = 0.0;  // healed, to far below an atom
  deepest_J_ = elastic_energy_J(deepest_m_);
}

// eta at `surface_m`.
double SofteningBlock::softened(double surface_m) const noexcept {
  if (surface_m >= deepest_m_) return 1.0;
  const double below_J = deepest_J_ - elastic_energy_J(surface_m);
  return 1.0 - kSoftening * std::erf(below_J / (kSharpness_J + kSharpnessShare * deepest_J_));
}

double SofteningBlock::contact_force_N(double surface_m, double) const noexcept {
  const double elastic_N = elastic_force_N(surface_m);
  return softened(surface_m) * elastic_N + spectrum_.memory_N(elastic_N - elastic_N_);
}

void SofteningBlock::settle(double surface_m, bool) noexcept {
  const double elastic_N = elastic_force_N(surface_m);
  spectrum_.settle(elastic_N - elastic_N_);
  elastic_N_ = elastic_N;
  if (surface_m > deepest_m_) deepest_m_ = surface_m;
}

void SofteningBlock::forget(double surface_m) noexcept {
  spectrum_.forget();
  elastic_N_ = elastic_force_N(surface_m);
  deepest_m_ = surface_m;
}

}  // namespace palpate
