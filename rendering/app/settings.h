// What the window remembers between runs: how things are shown, never what is shown.
// A small JSON file in the user's configuration folder.
// Thread guarantee: slow side; does I/O.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"
#include "rendering/panels/view_state.h"
#include "rendering/picture/camera.h"

namespace palpate {

struct Settings {
  Theme theme = Theme::light;
  std::size_t block_count = 4;
  bool difference = true;
  float text_size = 1.0F;
  std::string line_up;              // empty: the default
  std::vector<std::string> recent;  // files that were opened, the newest first
  CameraTurn camera;
};

// A file that is not there gives the defaults, and so does a field that is not there or
// not possible: settings are no data. Errors: a file that is there and is no JSON.
Result<Settings> read_settings(const std::string& path);
Status write_settings(const std::string& path, const Settings& settings);

}  // namespace palpate
