// The checks of palpate check, as the verbs run them before they use recordings.
// Thread guarantee: slow side (does I/O).
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"
#include "models/check/check_recording.h"
#include "scenes/scene/scene.h"

namespace palpate::cli {

// What the scene asks of a recording.
CheckRequest check_request(const Scene& scene);

// What the check found, as palpate check prints it.
std::string check_text(const CheckedFile& file);

// Reads and checks `paths`: an error for the first fatal finding, a line on stderr for
// each warning.
Result<std::vector<CheckedFile>> check_before_use(const std::vector<std::string>& paths, const CheckRequest& request);

}  // namespace palpate::cli
