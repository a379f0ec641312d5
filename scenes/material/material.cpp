#include "scenes/material/material.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace palpate {
namespace {

constexpr double kLongestSubstep_s = 1e-4;
constexpr double kMostSubsteps = 1000.0;
// Far below anything a sensor sees; keeps a block that rests in free air from
// computing with denormal numbers.
constexpr double kFlat_m = 1e-15;
constexpr double kNoForce_N = 1e-30;

constexpr std::array<Material, 5> kMaterials = {{
    {.name = "silicone",
     .summary = "soft rubber block, the paper's kind: elastic, viscous, two relaxations",
     .elastic_linear_N_per_m = 330.0,
     .elastic_quadratic_N_per_m2 = 1.2e4,
     .elastic_cubic_N_per_m3 = 1.2e6,
     .viscosity_Ns_per_m2 = 800.0,
     .thick_fraction = 0.5,
     .thinning_speed_m_per_s = 0.15,
     .branch_count = 2,
     .branches = {{{0.17, 70.0, 9.0e3}, {1.27, 50.0, 6.0e3}}},
     .recording_seconds = 41.499},
    {.name = "foam",
     .summary = "open-cell foam: a plateau, then densification; hysteresis, two relaxations",
     .elastic_linear_N_per_m = 520.0,
     .elastic_quadratic_N_per_m2 = -6.5e4,
     .elastic_cubic_N_per_m3 = 3.6e6,
     .viscosity_Ns_per_m2 = 260.0,
     .thick_fraction = 0.6,
     .thinning_speed_m_per_s = 0.1,
     .friction_fraction = 0.025,
     .friction_stiffness_N_per_m = 60.0,
     .branch_count = 2,
     .branches = {{{0.08, 60.0, 5.0e3}, {0.9, 45.0, 3.0e3}}},
     .recording_seconds = 41.499},
    {.name = "elastic",
     .summary = "ideal spring: the force follows from the position alone",
     .elastic_linear_N_per_m = 400.0,
     .elastic_quadratic_N_per_m2 = 1.5e4,
     .elastic_cubic_N_per_m3 = 2.0e6,
     .recording_seconds = 30.0},
    {.name = "stiff",
     .summary = "hard block, 3 kN/m, light damping: the hard case for stability",
     .elastic_linear_N_per_m = 3000.0,
     .viscosity_Ns_per_m2 = 2000.0,
     .recording_seconds = 30.0},
    {.name = "gel",
     .summary = "very viscous gel: three relaxations from quick to slow",
     .elastic_linear_N_per_m = 170.0,
     .elastic_quadratic_N_per_m2 = 6.0e3,
     .elastic_cubic_N_per_m3 = 6.0e5,
     .viscosity_Ns_per_m2 = 500.0,
     .thick_fraction = 0.4,
     .thinning_speed_m_per_s = 0.1,
     .branch_count = 3,
     .branches = {{{0.05, 60.0, 5.0e3}, {0.4, 60.0, 5.0e3}, {2.5, 50.0, 4.0e3}}},
     .recording_seconds = 41.499},
}};

}  // namespace

double Material::elastic_force_N(double depth_m) const noexcept {
  return depth_m * (elastic_linear_N_per_m +
                    depth_m * (elastic_quadratic_N_per_m2 + depth_m * elastic_cubic_N_per_m3));
}

double Material::unrelaxed_force_N(std::size_t branch, double depth_m) const noexcept {
  const RelaxationBranch& b = branches[branch];
  return depth_m * (b.stiffness_N_per_m + 0.5 * b.stiffness_slope_N_per_m2 * depth_m);
}

double Material::viscous_force_N(double depth_m, double rate_m_per_s) const noexcept {
  const double thinned =
      (1.0 - thick_fraction) / (1.0 + std::abs(rate_m_per_s) / thinning_speed_m_per_s);
  return viscosity_Ns_per_m2 * depth_m * rate_m_per_s * (thick_fraction + thinned);
}

std::span<const Material> materials() noexcept { return kMaterials; }

Result<Material> find_material(std::string_view name) {
  std::string known;
  for (const Material& material : kMaterials) {
    if (material.name == name) return material;
    known += known.empty() ? "" : ", ";
    known += material.name;
  }
  return Error{"unknown material '" + std::string(name) + "'; known: " + known};
}

std::string relaxation_times_text(const Material& material) {
  if (material.branch_count == 0) return "none";
  std::string text;
  for (std::size_t b = 0; b < material.branch_count; ++b) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits,
                                   material.branches[b].relaxation_time_s);
    text += b == 0 ? "" : ", ";
    text.append(digits, end.ptr);
    text += " s";
  }
  return text;
}

void MaterialState::reset(double position_m) noexcept {
  const Material kept = material_;
  *this = MaterialState(kept);
  position_m_ = position_m;
  surface_m_ = std::max(0.0, position_m);
}

double MaterialState::step(double position_m, double velocity_m_per_s, double dt_s) noexcept {
  if (!std::isfinite(position_m) || !std::isfinite(velocity_m_per_s) || !std::isfinite(dt_s) ||
      dt_s <= 0.0) {
    return force_N_;
  }
  // The small excess keeps a dt of 1 ms, inexact in binary, at ten sub-steps.
  const int count = static_cast<int>(
      std::clamp(std::ceil(dt_s / kLongestSubstep_s * (1.0 - 1e-9)), 1.0, kMostSubsteps));
  prepare(dt_s / count);
  const double x0 = position_m_, v0 = velocity_m_per_s_;
  for (int i = 1; i < count; ++i) {
    const double u = static_cast<double>(i) / count;
    const double rest = 1.0 - u;
    const double rise = u * u * (3.0 - 2.0 * u);
    const double x = x0 + (position_m - x0) * rise +
                     dt_s * u * rest * (v0 * rest - velocity_m_per_s * u);
    const double v = 6.0 * u * rest * (position_m - x0) / dt_s + v0 * rest * (1.0 - 3.0 * u) +
                     velocity_m_per_s * u * (3.0 * u - 2.0);
    substep(x, v);
  }
  substep(position_m, velocity_m_per_s);
  position_m_ = position_m;
  velocity_m_per_s_ = velocity_m_per_s;
  return force_N_;
}

// The branch factors depend on the sub-step alone, which rarely changes.
void MaterialState::prepare(double substep_s) noexcept {
  if (substep_s == substep_s_) return;
  substep_s_ = substep_s;
  for (std::size_t b = 0; b < material_.branch_count; ++b) {
    const double ratio = substep_s / material_.branches[b].relaxation_time_s;
    decay_[b] = std::exp(-ratio);
    gain_[b] = -std::expm1(-ratio) / ratio;
  }
}

// The elements with memory after the surface has moved from surface_m_ to
// `surface_m` within one sub-step, g_b changing evenly: exact for that path.
MaterialState::Inner MaterialState::inner_at(double surface_m) const noexcept {
  Inner inner;
  const double elastic_N = material_.elastic_force_N(surface_m);
  inner.static_force_N = elastic_N;
  for (std::size_t b = 0; b < material_.branch_count; ++b) {
    const double change_N =
        material_.unrelaxed_force_N(b, surface_m) - material_.unrelaxed_force_N(b, surface_m_);
    inner.branch_N[b] = branch_force_N_[b] * decay_[b] + change_N * gain_[b];
    inner.static_force_N += inner.branch_N[b];
  }
  const double limit_N = material_.friction_fraction * elastic_N;
  const double dragged_N =
      friction_N_ + material_.friction_stiffness_N_per_m * (surface_m - surface_m_);
  inner.friction_N = std::clamp(dragged_N, -limit_N, limit_N);
  inner.static_force_N += inner.friction_N;
  return inner;
}

// The force on a free surface that goes to `surface_m`: 0 where it will be.
double MaterialState::residual_N(double surface_m) const noexcept {
  const double rate_m_per_s = (surface_m - surface_m_) / substep_s_;
  return inner_at(surface_m).static_force_N + material_.viscous_force_N(surface_m, rate_m_per_s);
}

// Root of residual_N between the tool's depth, where it is negative, and the
// surface's last place, by regula falsi (Illinois): the residual rises with
// depth and is nearly straight over one sub-step.
double MaterialState::free_surface_m(double depth_m, double depth_residual_N) const noexcept {
  double low_m = depth_m, low_N = depth_residual_N;
  double high_m = surface_m_, high_N = residual_N(high_m);
  if (high_N <= 0.0) return high_m;
  int side = 0;
  for (int i = 0; i < 24 && high_m - low_m > kFlat_m; ++i) {
    const double middle_m = (low_m * high_N - high_m * low_N) / (high_N - low_N);
    const double middle_N = residual_N(middle_m);
    if (middle_N == 0.0) return middle_m;
    if (middle_N < 0.0) {
      low_m = middle_m, low_N = middle_N;
      if (side < 0) high_N *= 0.5;
      side = -1;
    } else {
      high_m = middle_m, high_N = middle_N;
      if (side > 0) low_N *= 0.5;
      side = 1;
    }
  }
  return high_m;
}

void MaterialState::settle(double surface_m, const Inner& inner) noexcept {
  surface_m_ = surface_m > kFlat_m ? surface_m : 0.0;
  friction_N_ = inner.friction_N;
  for (std::size_t b = 0; b < material_.branch_count; ++b) {
    const double branch_N = inner.branch_N[b];
    branch_force_N_[b] = std::abs(branch_N) > kNoForce_N ? branch_N : 0.0;
  }
}

void MaterialState::substep(double position_m, double velocity_m_per_s) noexcept {
  const double depth_m = std::max(0.0, position_m);
  if (depth_m < surface_m_) {
    const double residual = residual_N(depth_m);
    if (residual < 0.0) {
      const double free_m = free_surface_m(depth_m, residual);
      settle(free_m, inner_at(free_m));
      touching_ = false;
      force_N_ = 0.0;
      return;
    }
  }
  const Inner inner = inner_at(depth_m);
  settle(depth_m, inner);
  touching_ = depth_m > 0.0;
  const double viscous_N = material_.viscous_force_N(depth_m, velocity_m_per_s);
  force_N_ = touching_ ? std::max(0.0, inner.static_force_N + viscous_N) : 0.0;
}

}  // namespace palpate
