// The virtual materials by name. Each material law has its own header and shares no code with the models that are
// fitted to it. Thread guarantee: pure functions; `make_block` allocates.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "devices/virtual/hand_motion.h"
#include "engine/base/result.h"
#include "scenes/material/block.h"

namespace palpate {

inline constexpr double kUsualRecording_s = 41.499, kUsualForceRange_N = 10.0;

struct Material {
  std::string_view name;
  std::string_view summary;           // one line
  std::string_view relaxation_times;  // the true ones, in words
  // Returns an undeformed block with the parameters of this material.
  std::unique_ptr<Block> (*make_block)() = nullptr;
  double recording_seconds = kUsualRecording_s;                 // default length of a recording
  double force_range_N = kUsualForceRange_N;                    // default range of the force sensor
  double strongest_press_N = HandSettings{}.strongest_press_N;  // default of the hand of a recording
};

// All materials, in the order of lists.
std::span<const Material> materials() noexcept;

// Errors: unknown name; lists the known names.
Result<Material> find_material(std::string_view name);

}  // namespace palpate
