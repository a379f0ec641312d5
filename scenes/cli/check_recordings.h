// The checks of palpate check, which other verbs run before they use recordings.
// Thread guarantee: slow side (does I/O).
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"
#include "models/check/check_recording.h"
#include "scenes/scene/scene.h"

namespace palpate::cli {

// The JND line and the relaxation times of the scene.
CheckRequest check_request(const Scene& scene);

// The output of palpate check.
std::string check_text(const CheckedFile& file);

// Reads and checks `paths` and prints a line on stderr for each warning. Errors: a file cannot be read or is unusable.
Result<std::vector<CheckedFile>> check_before_use(const std::vector<std::string>& paths, const CheckRequest& request);

}  // namespace palpate::cli
