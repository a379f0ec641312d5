// What the window remembers between runs (Settings in view_state.h), as a small JSON file in
// the user's configuration folder.
// Thread guarantee: slow side; does I/O.
#pragma once

#include <string>

#include "engine/base/result.h"
#include "rendering/panels/view_state.h"

namespace palpate {

// A file that is not there gives the defaults, and so does a field that is not there or
// not possible: settings are no data. Errors: a file that is there and is no JSON.
Result<Settings> read_settings(const std::string& path);
Status write_settings(const std::string& path, const Settings& settings);

}  // namespace palpate
