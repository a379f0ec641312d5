
#include <string>
#include <vector>

#include "scenes/material/material.h"

#include "engine/base/text.h"
#include "scenes/material/material_laws.h"

namespace palpate {
namespace {

constexpr double kLongestSubstep_s = 1e-4;
constexpr double kMostSubsteps = 1000.0;
constexpr double kFlat_m = 1e-15;
// Tolerance of the force on a free surface, far below the noise of force sensors. An exact root would take most of the
// time of a tick.
constexpr double kFree_N = 1e-11;
template <typename Law>
std::unique_ptr<Block> make() {
  return std::make_unique<Law>();
}

// A sphere of 10 mm radius; relaxed Young's modulus 25 kPa, as the softest platinum-cured silicones. The instantaneous
// force is 1.6 times the relaxed one.
std::unique_ptr<Block> make_silicone() {
  return std::make_unique<HereditaryBlock>(SphereContact{.radius_m = 0.01, .modulus_Pa = 25e3}, 0.001, 30.0, 0.06);
}

template <const MaxwellParameters& parameters>
std::unique_ptr<Block> make_maxwell() {
  return std::make_unique<MaxwellBlock>(parameters);
}

constexpr Material kMaterials[] = {
    {"silicone", "soft rubber under a sphere, large strain, continuous relaxation", "continuous, 0.001 s to 30 s",
     make_silicone},
    {"layered", "soft block with a stiff inclusion 6 mm down", "continuous, 0.02 s to 4 s; 0.3 s under the inclusion",
     make<LayeredBlock>},
    {"friction", "soft block with a dry friction of 0.35 N on the probe", "continuous, 0.05 s to 2 s; dry friction",
     make<FrictionBlock>, kUsualRecording_s, kUsualForceRange_N, 3.0},
    {"sponge", "wet sponge, up to 17 N: its pore pressure drains, and more slowly when squeezed",
     "a series of diffusion times, 0.2 s and shorter, longer with depth", make<SpongeBlock>, kUsualRecording_s, 25.0,
     14.0},
    {"button", "rubber dome that snaps through: a click, hysteresis and a hard stop", "0.25 s; dry friction",
     make<ButtonBlock>},
    {"maxwell", "springs and dashpots with two known relaxation times", "0.17 s, 1.27 s", make_maxwell<kMaxwell>},
    {"foam", "open-cell foam: a plateau, then densification; hysteresis, two relaxations", "0.08 s, 0.9 s",
     make_maxwell<kFoam>},
    {"elastic", "ideal spring: the force depends only on the position", "none", make_maxwell<kElastic>, 30.0},
    {"stiff", "hard block, 3 kN/m, with little damping: a difficult case for stability", "none", make_maxwell<kStiff>,
     30.0},
};

}  // namespace

void Block::reset(double position_m) noexcept {
  position_m_ = position_m;
  velocity_m_per_s_ = 0.0;
  surface_m_ = std::max(0.0, position_m);
  force_N_ = 0.0;
  reset_state(surface_m_);
}

double Block::step(double position_m, double velocity_m_per_s, double dt_s) noexcept {
  if (!std::isfinite(position_m) || !std::isfinite(velocity_m_per_s) || !std::isfinite(dt_s) || dt_s <= 0.0)
    return force_N_;
  // The tolerance of 1e-9 gives ten sub-steps for 1 ms, which is inexact in binary.
  const int count =
      static_cast<int>(std::clamp(std::ceil(dt_s / kLongestSubstep_s * (1.0 - 1e-9)), 1.0, kMostSubsteps));
  if (dt_s / count != substep_s_) {
    substep_s_ = dt_s / count;
    prepare();
  }
  const double x0 = position_m_, v0 = velocity_m_per_s_;
  for (int i = 1; i < count; ++i) {
    const double u = static_cast<double>(i) / count;
    const double rest = 1.0 - u;
    const double rise = u * u * (3.0 - 2.0 * u);
    const double x = x0 + (position_m - x0) * rise + dt_s * u * rest * (v0 * rest - velocity_m_per_s * u);
    const double v = 6.0 * u * rest * (position_m - x0) / dt_s + v0 * rest * (1.0 - 3.0 * u) +
                     velocity_m_per_s * u * (3.0 * u - 2.0);
    substep(x, v);
  }
  substep(position_m, velocity_m_per_s);
  position_m_ = position_m;
  velocity_m_per_s_ = velocity_m_per_s;
  return force_N_;
}

// The force on a free surface that moves to `surface_m`; its root is the next depth of the surface.
double Block::residual_N(double surface_m) const noexcept {
  return free_force_N(surface_m, (surface_m - surface_m_) / substep_s_);
}

// Root of residual_N between the depth of the tool, where it is negative, and the last depth of the surface, by regula
// falsi (Illinois): the residual increases with depth and is nearly linear over one sub-step.
double Block::free_surface_m(double depth_m, double depth_residual_N) const noexcept {
  double low_m = depth_m, low_N = depth_residual_N;
  double high_m = surface_m_, high_N = residual_N(high_m);
  if (high_N <= 0.0) return high_m;
  int side = 0;
  for (int i = 0; i < 24 && high_m - low_m > kFlat_m; ++i) {
    const double middle_m = (low_m * high_N - high_m * low_N) / (high_N - low_N);
    const double middle_N = residual_N(middle_m);
    if (std::abs(middle_N) < kFree_N) return middle_m;
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

void Block::move_surface(double surface_m, bool touching) noexcept {
  update_state(surface_m, touching);
  surface_m_ = surface_m > kFlat_m ? surface_m : 0.0;
}

void Block::substep(double position_m, double velocity_m_per_s) noexcept {
  begin_substep();
  const double depth_m = std::max(0.0, position_m);
  if (depth_m < surface_m_) {
    const double residual = residual_N(depth_m);
    if (residual < -kFree_N) {
      move_surface(free_surface_m(depth_m, residual), false);
      force_N_ = 0.0;
      return;
    }
  }
  const bool touching = depth_m > 0.0;
  force_N_ = touching ? std::max(0.0, contact_force_N(depth_m, velocity_m_per_s)) : 0.0;
  move_surface(depth_m, touching);
}

std::span<const Material> materials() noexcept { return kMaterials; }

Result<Material> find_material(std::string_view name) {
  std::vector<std::string> known;
  for (const Material& material : kMaterials) {
    if (material.name == name) return material;
    known.emplace_back(material.name);
  }
  return Error{"unknown material '" + std::string(name) + "'; known: " + joined(known)};
}

}  // namespace palpate
