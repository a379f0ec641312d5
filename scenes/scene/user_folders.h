// Where a person's files belong, settings and what the window records, and the time in their names.
// Source: XDG Base Directory Specification 0.8.
// Thread guarantee: pure but for the environment and the file system; slow side.
#pragma once

#include <string>

#include "engine/base/result.h"

namespace palpate {

// $XDG_CONFIG_HOME/palpate, else ~/.config/palpate; made when it is not there.
// Errors: no home, or it cannot be made.
Result<std::string> config_folder();

// $XDG_DATA_HOME/palpate, else ~/.local/share/palpate; likewise. Recordings, figures
// and files about faults go there.
Result<std::string> data_folder();

// Now, in the machine's time zone, as strftime writes `format`: at most 63 bytes.
std::string local_time_text(const char* format);

}  // namespace palpate
