// The user's folders for settings and data, and the time for file names.
// Source: XDG Base Directory Specification 0.8.
// Thread guarantee: slow side; reads the environment and creates folders.
#pragma once

#include <string>

#include "engine/base/result.h"

namespace palpate {

// $XDG_CONFIG_HOME/palpate, else ~/.config/palpate. Creates the folder. Errors: neither the variable nor HOME is set;
// the folder cannot be created.
Result<std::string> config_folder();

// $XDG_DATA_HOME/palpate, else ~/.local/share/palpate, for recordings, figures and fault files. As config_folder.
Result<std::string> data_folder();

// The local time now, formatted by strftime with `format`; empty beyond 63 bytes.
std::string local_time_text(const char* format);

}  // namespace palpate
