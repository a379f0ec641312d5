#include "scenes/material/maxwell_block.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace palpate {

double MaxwellParameters::elastic_force_N(double depth_m) const noexcept {
  return depth_m * (elastic_linear_N_per_m + depth_m * (elastic_quadratic_N_per_m2 + depth_m * elastic_cubic_N_per_m3));
}

double MaxwellParameters::unrelaxed_force_N(std::size_t branch, double depth_m) const noexcept {
  const RelaxationBranch& b = branches[branch];
  return depth_m * (b.stiffness_N_per_m + 0.5 * b.stiffness_slope_N_per_m2 * depth_m);
}

double MaxwellParameters::viscous_force_N(double depth_m, double rate_m_per_s) const noexcept {
  const double thinned = (1.0 - thick_fraction) / (1.0 + std::abs(rate_m_per_s) / thinning_speed_m_per_s);
  return viscosity_Ns_per_m2 * depth_m * rate_m_per_s * (thick_fraction + thinned);
}

double MaxwellBlock::held_force_N(double depth_m) const noexcept {
  double held_N = material_.elastic_force_N(depth_m);
  for (std::size_t b = 0; b < material_.branch_count; ++b) {
    held_N += 0.5 * material_.unrelaxed_force_N(b, depth_m);
  }
  return held_N;
}

std::string MaxwellBlock::relaxation_times_text() const {
  if (material_.branch_count == 0) return "none";
  std::string text;
  for (std::size_t b = 0; b < material_.branch_count; ++b) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, material_.branches[b].relaxation_time_s);
    text += b == 0 ? "" : ", ";
    text.append(digits, end.ptr);
    text += " s";
  }
  return text;
}

void MaxwellBlock::prepare() noexcept {
  for (std::size_t b = 0; b < material_.branch_count; ++b) {
    const double ratio = substep_s() / material_.branches[b].relaxation_time_s;
    decay_[b] = std::exp(-ratio);
    gain_[b] = -std::expm1(-ratio) / ratio;
  }
}

// The elements with memory after the surface has moved to `surface_m` within one
// sub-step, g_b changing evenly: exact for that path.
MaxwellBlock::Inner MaxwellBlock::inner_at(double surface_m) const noexcept {
  Inner inner;
  const double elastic_N = material_.elastic_force_N(surface_m);
  inner.static_force_N = elastic_N;
  for (std::size_t b = 0; b < material_.branch_count; ++b) {
    const double change_N =
        material_.unrelaxed_force_N(b, surface_m) - material_.unrelaxed_force_N(b, last_surface_m());
    inner.branch_N[b] = branch_force_N_[b] * decay_[b] + change_N * gain_[b];
    inner.static_force_N += inner.branch_N[b];
  }
  const double limit_N = material_.friction_fraction * elastic_N;
  const double dragged_N = friction_N_ + material_.friction_stiffness_N_per_m * (surface_m - last_surface_m());
  inner.friction_N = std::clamp(dragged_N, -limit_N, limit_N);
  inner.static_force_N += inner.friction_N;
  return inner;
}

double MaxwellBlock::contact_force_N(double surface_m, double rate_m_per_s) const noexcept {
  return inner_at(surface_m).static_force_N + material_.viscous_force_N(surface_m, rate_m_per_s);
}

void MaxwellBlock::settle(double surface_m, bool) noexcept {
  const Inner inner = inner_at(surface_m);
  friction_N_ = inner.friction_N;
  for (std::size_t b = 0; b < material_.branch_count; ++b) {
    const double branch_N = inner.branch_N[b];
    branch_force_N_[b] = std::abs(branch_N) > kNoForce_N ? branch_N : 0.0;
  }
}

void MaxwellBlock::forget(double) noexcept {
  friction_N_ = 0.0;
  branch_force_N_ = {};
}

}  // namespace palpate
