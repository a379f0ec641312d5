// The output of palpate fit.
// Thread guarantee: slow side.
#pragma once

#include <string>

#include "models/fit_library/fit_recordings.h"

namespace palpate::cli {

// `sensor`: printed after the share of the training within the JND; `out`: the file that was written.
void print_fit(const RecordingsFit& fitted, const std::string& sensor, const std::string& out);

}  // namespace palpate::cli
