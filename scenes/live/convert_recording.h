// Opens a file that the user drops on the window or names: a recording, or a table of another program, which is
// converted to a recording file (engine/import).
// Thread guarantee: slow side (does I/O); any thread.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"

namespace palpate {

struct ConvertedRecording {
  std::string path;                // of the recording
  std::vector<std::string> words;  // the columns that were found and the guesses; empty: the file was a recording
};

// Whether a file may be a recording: it has an extension other than .json (models).
bool may_be_recording(const std::string& path);

// `folder`: where a converted recording is written. Errors: those of read_recording or import_table; the new file
// cannot be written.
Result<ConvertedRecording> convert_recording(const std::string& path, const std::string& folder);

}  // namespace palpate
