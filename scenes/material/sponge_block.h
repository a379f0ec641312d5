// A wet sponge under a flat tool: the skeleton carries a part of the load and the pore fluid the rest, until the
// fluid has drained radially from under the tool. With the strain e = s / L of the column under the tool and the pore
// pressure p(r, t):
//   F = A (sigma(e) + mean of p over the tool)
//   dp/dt = M de/dt + (1 / r) d/dr (r k(e) M dp/dr),   p(a) = 0,  dp/dr(0) = 0
//   sigma(e) = E e / (1 - e / e_d)                      densification of open cells
//   k(e) = k0 exp(-b e)                                 permeability decreases with strain
// The drainage has a series of relaxation times a^2 / (k M j_n^2) with the zeros j_n of J0 (2.405, 5.52, ...), which
// are twelve times longer at a strain of 0.5. The pressure is integrated by finite volumes in 12 rings with implicit
// Euler, with k(e) of the beginning of the sub-step.
// L = 30 mm, a = 12 mm; E = 9 kPa, e_d = 0.8; M = 160 kPa; longest time 0.2 s when uncompressed; b = 5.
// Passive: A L (integral of sigma de + mean p^2 / (2 M)) is stored, drainage dissipates, and so does implicit Euler.
// Source: Biot (1941); Mow, Kuei, Lai & Armstrong (1980) (biphasic theory); Armstrong, Lai & Mow (1984) (radial
// drainage under a plate); Lai & Mow (1980) (permeability and strain); Gibson & Ashby (1997) (densification).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
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

  // After a press of some tenths of a second the pore pressure is about a tenth of its undrained value.
  double half_relaxed_force_N(double depth_m) const noexcept override {
    return relaxed_force_N(depth_m) + 0.1 * kArea_m2 * kPore_Pa * depth_m / kHeight_m;
  }
  // A sigma(e).
  double relaxed_force_N(double depth_m) const noexcept {
    constexpr double kMostClosed = 0.9;  // upper limit of e / e_d in the denominator
    const double strain = depth_m / kHeight_m;
    const double closed = std::min(kMostClosed, strain / kClosed_strain);
    return kArea_m2 * kSkeleton_Pa * strain / (1.0 - closed);
  }

 private:
  using Rings = std::array<double, kRings>;
  static constexpr double kArea_m2 = 3.14159265358979324 * kRadius_m * kRadius_m;
  static constexpr double kRingCount = static_cast<double>(kRings);

  // The ring's share of the tool's area. Rings have equal width.
  static constexpr double ring_share(std::size_t ring) {
    return (2.0 * static_cast<double>(ring) + 1.0) / (kRingCount * kRingCount);
  }
  // Conductance of the outer edge of `ring`: perimeter / distance of the pressures, over 2 pi. The boundary pressure
  // 0 is only half a ring's width away.
  static constexpr double ring_edge(std::size_t ring) {
    const double outer = static_cast<double>(ring) + 1.0;
    return ring + 1 == kRings ? 2.0 * outer : outer;
  }
  // Solves (I - h D) p = p_old + M de for any de: one elimination with two right-hand sides.
  void begin_substep() noexcept override {
    const double strain = surface_depth_m() / kHeight_m;
    const double width_m = kRadius_m / kRingCount;
    const double flow =
        substep_s() * kDiffusivity_m2_per_s * std::exp(-kPermeabilityFall * strain) / (width_m * width_m);
    Rings above{};  // upper diagonal, divided by the pivot
    double from_inside = 0.0, last_drained = 0.0, last_squeezed = 0.0;
    for (std::size_t i = 0; i < kRings; ++i) {
      const double volume = static_cast<double>(i) + 0.5;
      const double inner = i == 0 ? 0.0 : flow * ring_edge(i - 1);
      const double outer = flow * ring_edge(i);
      const double pivot = 1.0 / (volume + inner + outer - inner * from_inside);
      drained_Pa_[i] = last_drained = (volume * pressure_Pa_[i] + inner * last_drained) * pivot;
      squeezed_Pa_[i] = last_squeezed = (volume * kPore_Pa + inner * last_squeezed) * pivot;
      above[i] = from_inside = i + 1 < kRings ? outer * pivot : 0.0;
    }
    mean_drained_Pa_ = mean_squeezed_Pa_ = 0.0;
    for (std::size_t i = kRings; i-- > 0;) {
      if (i + 1 < kRings) {
        drained_Pa_[i] += above[i] * drained_Pa_[i + 1];
        squeezed_Pa_[i] += above[i] * squeezed_Pa_[i + 1];
      }
      mean_drained_Pa_ += ring_share(i) * drained_Pa_[i];
      mean_squeezed_Pa_ += ring_share(i) * squeezed_Pa_[i];
    }
  }
  double strained(double surface_m) const noexcept { return (surface_m - surface_depth_m()) / kHeight_m; }
  double contact_force_N(double surface_m, double) const noexcept override {
    return relaxed_force_N(surface_m) + kArea_m2 * (mean_drained_Pa_ + mean_squeezed_Pa_ * strained(surface_m));
  }
  void update_state(double surface_m, bool) noexcept override {
    constexpr double kNoPressure_Pa = 1e-25;
    for (std::size_t i = 0; i < kRings; ++i) {
      const double pressure_Pa = drained_Pa_[i] + squeezed_Pa_[i] * strained(surface_m);
      pressure_Pa_[i] = std::abs(pressure_Pa) > kNoPressure_Pa ? pressure_Pa : 0.0;
    }
  }
  void reset_state(double) noexcept override { pressure_Pa_.fill(0.0); }

  Rings pressure_Pa_{};
  // At the end of the sub-step pressure = drained_ + squeezed_ x change of strain, likewise for the means over the
  // tool.
  Rings drained_Pa_{}, squeezed_Pa_{};
  double mean_drained_Pa_ = 0.0, mean_squeezed_Pa_ = 0.0;
};

}  // namespace palpate
