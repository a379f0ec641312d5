// The folders of the program: the assets (scenes, models, shaders, fonts), and the user's settings and data.
// If the environment variable PALPATE_ASSETS is set, only that folder is tried for the assets. Else, in this order,
// relative to the executable's folder: `../share/palpate` (an installed program), `../assets` (a build folder); then
// the source tree.
// Source of the user's folders: XDG Base Directory Specification 0.8.
// Thread guarantee: slow side only (does I/O); reads the environment.
#pragma once

#include <string>

#include "engine/base/result.h"

namespace palpate {

// Errors: no folder has a subfolder scenes; lists the folders that were tried.
Result<std::string> find_assets();

// The folder of the devices' calibrations; empty where there are no assets.
std::string calibrations_folder();

// $XDG_CONFIG_HOME/palpate, else ~/.config/palpate. Creates the folder. Errors: neither the variable nor HOME is set;
// the folder cannot be created.
Result<std::string> config_folder();

// $XDG_DATA_HOME/palpate, else ~/.local/share/palpate, for recordings, figures and fault files. As config_folder.
Result<std::string> data_folder();

// The local time now for a file name, formatted by strftime with `format`; empty beyond 63 bytes.
std::string local_time_text(const char* format);

}  // namespace palpate
