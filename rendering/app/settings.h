// The settings that the window keeps between runs (Settings in view_state.h), in a JSON file in the user's
// configuration folder.
// Thread guarantee: slow side; does I/O.
#pragma once

#include <string>

#include "engine/base/result.h"
#include "rendering/panels/view_state.h"

namespace palpate {

// A missing file, and a missing or invalid field, give the defaults. Errors: the file is no JSON object.
Result<Settings> read_settings(const std::string& path);
Status write_settings(const std::string& path, const Settings& settings);

}  // namespace palpate
