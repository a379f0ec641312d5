// A file that somebody drops on the window or names: a recording as it is, or another
// program's table, which becomes one (engine/import) in the user's data folder.
// Thread guarantee: slow side (does I/O); any thread.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"

namespace palpate {

struct RecordingOffer {
  std::string path;                // of a recording that can be fitted and replayed
  std::vector<std::string> words;  // what an import found and guessed; none: it was one
};

// Whether a file is offered as a recording: anything with an ending but a model (.json).
bool is_offered(const std::string& path);

// Errors: those of read_recording or import_table; the new file cannot be written.
Result<RecordingOffer> offer_recording(const std::string& path, const std::string& folder);

}  // namespace palpate
