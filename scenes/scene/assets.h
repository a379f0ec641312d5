// Finds the folder of the assets: scenes, models, shaders, fonts.
// If the environment variable PALPATE_ASSETS is set, only that folder is tried. Else, in this order, relative to the
// executable's folder: `../share/palpate` (an installed program), `../assets` (a build folder); then the source tree.
// Thread guarantee: slow side only (does I/O).
#pragma once

#include <string>

#include "engine/base/result.h"

namespace palpate {

// Errors: no folder has a subfolder scenes; lists the folders that were tried.
Result<std::string> find_assets();

// The folder of the devices' calibrations; empty where there are no assets.
std::string calibrations_folder();

}  // namespace palpate
