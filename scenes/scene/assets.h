// Where the files under assets/ are: scenes, models, shaders, fonts.
//
// In this order: PALPATE_ASSETS of the environment (nothing else is tried then), `../share/palpate` beside
// the running executable's folder (an installed program), `../assets` (one in build/), the source tree.
// Thread guarantee: slow side only (does I/O).
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"

namespace palpate {

// The assets folder. Errors: none of the places is a folder; names them all.
Result<std::string> find_assets();

// The same for given places, first folder wins.
Result<std::string> first_assets_folder(const std::vector<std::string>& places);

}  // namespace palpate
