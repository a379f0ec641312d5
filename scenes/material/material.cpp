#include "scenes/material/material.h"

#include <string>
#include <vector>

#include "engine/base/text.h"
#include "scenes/material/button_block.h"
#include "scenes/material/friction_block.h"
#include "scenes/material/layered_block.h"
#include "scenes/material/maxwell_block.h"
#include "scenes/material/sponge_block.h"

namespace palpate {
namespace {

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
