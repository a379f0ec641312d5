// The virtual materials by name. Each law stands in a file of its own, written from its own physics and
// integrated in time; none shares anything with the models that are fitted to it.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "devices/virtual/hand_motion.h"
#include "engine/base/result.h"
#include "scenes/material/block.h"

namespace palpate {

struct Material {
  std::string_view name;
  std::string_view summary;           // one line for people
  std::string_view relaxation_times;  // the true ones, for people
  // A block that nobody has touched yet.
  std::unique_ptr<Block> (*make_block)() = nullptr;
  double recording_seconds = 41.499;  // length of a recording unless told otherwise
  double force_range_N = 10.0;        // of the force cell that suits it
  HandSettings hand{};                // the hand that presses it in a recording
};

// All materials, in the order in which they are listed to people.
std::span<const Material> materials() noexcept;

// The material of that name. Errors: unknown name; the message lists the known.
Result<Material> find_material(std::string_view name);

}  // namespace palpate
