#include "scenes/material/material.h"

#include <array>
#include <string>

#include "scenes/material/button_block.h"
#include "scenes/material/friction_block.h"
#include "scenes/material/layered_block.h"
#include "scenes/material/maxwell_block.h"
#include "scenes/material/silicone_block.h"
#include "scenes/material/softening_block.h"
#include "scenes/material/sponge_block.h"
#include "scenes/material/tissue_block.h"

namespace palpate {
namespace {

template <typename Law>
std::unique_ptr<Block> make() {
  return std::make_unique<Law>();
}

template <const MaxwellParameters& parameters>
std::unique_ptr<Block> make_maxwell() {
  return std::make_unique<MaxwellBlock>(parameters);
}

constexpr std::array kMaterials = {
    Material{.name = "silicone",
             .summary = "soft rubber under a sphere, large strain, continuous relaxation",
             .relaxation_times = "continuous, 0.001 s to 30 s",
             .make_block = &make<SiliconeBlock>},
    Material{.name = "tissue",
             .summary = "soft tissue: stiffens exponentially, relaxes as a power law of time",
             .relaxation_times = "a power law of time, t^-0.15",
             .make_block = &make<TissueBlock>},
    Material{.name = "softening",
             .summary = "foam that softens below its deepest press and heals in 6 s",
             .relaxation_times = "continuous, 0.01 s to 3 s; heals in 6 s",
             .make_block = &make<SofteningBlock>},
    Material{.name = "layered",
             .summary = "soft block with a stiff inclusion 6 mm down",
             .relaxation_times = "continuous, 0.02 s to 4 s; 0.3 s under the inclusion",
             .make_block = &make<LayeredBlock>},
    Material{.name = "friction",
             .summary = "soft block with a dry friction of 0.35 N on the probe",
             .relaxation_times = "continuous, 0.05 s to 2 s; dry friction",
             .make_block = &make<FrictionBlock>,
             .hand = {.strongest_press_N = 3.0}},
    Material{.name = "sponge",
             .summary = "wet sponge, up to 17 N: its pore pressure drains, and more slowly when squeezed",
             .relaxation_times = "a series of diffusion times, 0.2 s and shorter, longer with depth",
             .make_block = &make<SpongeBlock>,
             .force_range_N = 25.0,
             .hand = {.strongest_press_N = 14.0}},
    Material{.name = "button",
             .summary = "rubber dome that snaps through: a click, hysteresis and a hard stop",
             .relaxation_times = "0.25 s; dry friction",
             .make_block = &make<ButtonBlock>},
    Material{.name = "maxwell",
             .summary = "springs and dashpots with two known relaxation times",
             .relaxation_times = "0.17 s, 1.27 s",
             .make_block = &make_maxwell<kMaxwell>},
    Material{.name = "foam",
             .summary = "open-cell foam: a plateau, then densification; hysteresis, two relaxations",
             .relaxation_times = "0.08 s, 0.9 s",
             .make_block = &make_maxwell<kFoam>},
    Material{.name = "elastic",
             .summary = "ideal spring: the force depends only on the position",
             .relaxation_times = "none",
             .make_block = &make_maxwell<kElastic>,
             .recording_seconds = 30.0},
    Material{.name = "stiff",
             .summary = "hard block, 3 kN/m, with little damping: a difficult case for stability",
             .relaxation_times = "none",
             .make_block = &make_maxwell<kStiff>,
             .recording_seconds = 30.0},
    Material{.name = "gel",
             .summary = "very viscous gel with three relaxation times",
             .relaxation_times = "0.05 s, 0.4 s, 2.5 s",
             .make_block = &make_maxwell<kGel>},
};

}  // namespace

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

}  // namespace palpate
