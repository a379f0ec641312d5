#include "scenes/material/sponge_block.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

using std::size_t;

constexpr double kArea_m2 = 3.14159265358979324 * SpongeBlock::kRadius_m * SpongeBlock::kRadius_m;
constexpr double kRingCount = static_cast<double>(SpongeBlock::kRings);
// Nearly closed: from here on the skeleton stiffens no more.
constexpr double kMostClosed = 0.9;
constexpr double kNoPressure_Pa = 1e-25;

// The ring's share of the tool's area: rings are equally wide.
constexpr double ring_share(size_t ring) { return (2.0 * static_cast<double>(ring) + 1.0) / (kRingCount * kRingCount); }

double skeleton_N(double depth_m) {
  const double strain = depth_m / SpongeBlock::kHeight_m;
  const double closed = std::min(kMostClosed, strain / SpongeBlock::kClosed_strain);
  return kArea_m2 * SpongeBlock::kSkeleton_Pa * strain / (1.0 - closed);
}

// Over the outer edge of `ring`: diffusivity times perimeter over the distance of
// the pressures, per ring's width squared times 2 pi. At the rim the pressure 0
// is half a ring away.
constexpr double ring_edge(size_t ring) {
  const double outer = static_cast<double>(ring) + 1.0;
  return ring + 1 == SpongeBlock::kRings ? 2.0 * outer : outer;
}

}  // namespace

double SpongeBlock::relaxed_force_N(double depth_m) const noexcept { return skeleton_N(depth_m); }

// A press of some tenths of a second leaves in the pores about a tenth of what
// they would hold at once.
double SpongeBlock::held_force_N(double depth_m) const noexcept {
  return skeleton_N(depth_m) + 0.1 * kArea_m2 * kPore_Pa * depth_m / kHeight_m;
}

std::string SpongeBlock::relaxation_times_text() const {
  return "a diffusion's series, 0.2 s and quicker, slower with depth";
}

// Solves (I - h D) p = p_old + M de for any de: two right sides, one elimination.
void SpongeBlock::begin_substep() noexcept {
  const double strain = last_surface_m() / kHeight_m;
  const double width_m = kRadius_m / kRingCount;
  const double flow = substep_s() * kDiffusivity_m2_per_s * std::exp(-kPermeabilityFall * strain) / (width_m * width_m);
  Rings above{};  // of the diagonal, divided by the pivot
  double from_inside = 0.0, last_drained = 0.0, last_squeezed = 0.0;
  for (size_t i = 0; i < kRings; ++i) {
    const double volume = static_cast<double>(i) + 0.5;
    const double inner = i == 0 ? 0.0 : flow * ring_edge(i - 1);
    const double outer = flow * ring_edge(i);
    const double pivot = 1.0 / (volume + inner + outer - inner * from_inside);
    drained_Pa_[i] = last_drained = (volume * pressure_Pa_[i] + inner * last_drained) * pivot;
    squeezed_Pa_[i] = last_squeezed = (volume * kPore_Pa + inner * last_squeezed) * pivot;
    above[i] = from_inside = i + 1 < kRings ? outer * pivot : 0.0;
  }
  mean_drained_Pa_ = mean_squeezed_Pa_ = 0.0;
  for (size_t i = kRings; i-- > 0;) {
    if (i + 1 < kRings) {
      drained_Pa_[i] += above[i] * drained_Pa_[i + 1];
      squeezed_Pa_[i] += above[i] * squeezed_Pa_[i + 1];
    }
    mean_drained_Pa_ += ring_share(i) * drained_Pa_[i];
    mean_squeezed_Pa_ += ring_share(i) * squeezed_Pa_[i];
  }
}

double SpongeBlock::contact_force_N(double surface_m, double) const noexcept {
  const double change = (surface_m - last_surface_m()) / kHeight_m;
  return skeleton_N(surface_m) + kArea_m2 * (mean_drained_Pa_ + mean_squeezed_Pa_ * change);
}

void SpongeBlock::settle(double surface_m, bool) noexcept {
  const double change = (surface_m - last_surface_m()) / kHeight_m;
  for (size_t i = 0; i < kRings; ++i) {
    const double pressure_Pa = drained_Pa_[i] + squeezed_Pa_[i] * change;
    pressure_Pa_[i] = std::abs(pressure_Pa) > kNoPressure_Pa ? pressure_Pa : 0.0;
  }
}

void SpongeBlock::forget(double) noexcept { pressure_Pa_.fill(0.0); }

}  // namespace palpate
