// The folders of the program: the assets (scenes, calibrations, shaders, templates), and the user's settings and data.
// If the environment variable PALPATE_ASSETS is set, only that folder is tried for the assets. Otherwise these are
// tried in this order: `../share/palpate` (an installed program) and `../assets` (a build folder), relative to the
// folder of the executable; the source tree.
// Source of the user's folders: XDG Base Directory Specification 0.8.
// Thread guarantee: slow side only (does I/O); reads the environment.
#pragma once

#include <string>

#include "engine/base/result.h"

namespace palpate {

// Errors: none of these folders has a subfolder `scenes`; the message lists the folders.
Result<std::string> find_assets();

// The folder of the models that the build has fitted (scenes/worker/model_worker.h): `../share/palpate/ready` or
// `ready`, relative to the folder of the executable; empty where there is none.
std::string ready_models_folder();

// The folder of the devices' calibrations; empty where there are no assets.
std::string calibrations_folder();

// $XDG_CONFIG_HOME/palpate, else ~/.config/palpate. Creates the folder. Errors: neither the variable nor HOME is set;
// the folder cannot be created.
Result<std::string> config_folder();

// $XDG_DATA_HOME/palpate, else ~/.local/share/palpate: recordings, figures, fault files. Creates it. Errors: the same.
Result<std::string> data_folder();

// The local time for a file name, formatted by strftime with `format`; empty if it is longer than 63 bytes.
std::string local_time_text(const char* format);

}  // namespace palpate
