// Where the files under assets/ are: scenes, models, shaders, fonts.
//
// Looked for in this order: the folder named by the environment variable
// PALPATE_ASSETS (nothing else is tried then), `../share/palpate` beside the
// running executable's folder (an installed program), `../assets` (a program
// in build/), the source tree it was built from.
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
