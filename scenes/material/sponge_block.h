// A wet sponge under a flat tool: its skeleton carries some of the load and the
// fluid in its pores the rest, until that has seeped out sideways from under the
// tool. With the strain e = s / L of the column under the tool and the pore
// pressure p(r, t) in it:
//   F = A (sigma(e) + mean of p over the tool)
//   dp/dt = M de/dt + (1 / r) d/dr (r k(e) M dp/dr),   p(a) = 0,  dp/dr(0) = 0
//   sigma(e) = E e / (1 - e / e_d)                      open cells that close up
//   k(e) = k0 exp(-b e)                                 permeability falls with strain
// So the times over which the pressure drains, a^2 / (k M j_n^2) with j_n the
// zeros of J0 (2.405, 5.52, ...), are a series, and a press of half the height
// makes them twelve times longer. The pressure is integrated by finite volumes in 12 rings, implicit
// Euler, k taken at the beginning of a sub-step.
// L = 30 mm, a = 12 mm; E = 9 kPa, e_d = 0.8; M = 160 kPa; drains in 0.2 s when
// uncompressed; b = 5.
// Passive: A L (integral of sigma de + mean p^2 / (2 M)) is stored, and what seeps
// only loses; implicit Euler loses more.
// Source: Biot (1941); Mow, Kuei, Lai & Armstrong (1980) (biphasic theory);
// Armstrong, Lai & Mow (1984) (radial drainage under a plate); Lai & Mow (1980)
// (permeability and strain); Gibson & Ashby (1997) (foams close up).
#pragma once

#include <array>
#include <cstddef>

#include "scenes/material/block.h"

namespace palpate {

class SpongeBlock final : public Block {
 public:
  static constexpr std::size_t kRings = 12;
  static constexpr double kHeight_m = 0.03;                 // L
  static constexpr double kRadius_m = 0.012;                // a
  static constexpr double kSkeleton_Pa = 9e3;               // E
  static constexpr double kClosed_strain = 0.8;             // e_d
  static constexpr double kPore_Pa = 160e3;                 // M
  static constexpr double kDiffusivity_m2_per_s = 1.25e-4;  // k0 M
  static constexpr double kPermeabilityFall = 5.0;          // b

  double held_force_N(double depth_m) const noexcept override;
  double relaxed_force_N(double depth_m) const noexcept override;
  std::string relaxation_times_text() const override;

 private:
  using Rings = std::array<double, kRings>;
  void begin_substep() noexcept override;
  double contact_force_N(double surface_m, double rate_m_per_s) const noexcept override;
  void settle(double surface_m, bool touching) noexcept override;
  void forget(double surface_m) noexcept override;

  Rings pressure_Pa_{};
  // At the end of the sub-step: pressure = drained_ + squeezed_ times the change
  // of strain, and the same of the means over the tool.
  Rings drained_Pa_{}, squeezed_Pa_{};
  double mean_drained_Pa_ = 0.0, mean_squeezed_Pa_ = 0.0;
};

}  // namespace palpate
