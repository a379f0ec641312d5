// The recordings of a session: reading what the user drops on the window or names, the test part for a user with a
// single recording, and the limits of the simulated hand.
// Thread guarantee: slow side (convert_recording does I/O); any thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "devices/virtual/simulated_devices.h"
#include "engine/base/result.h"
#include "engine/recording/recording.h"

namespace palpate {

struct ConvertedRecording {
  std::string path;                // of the recording
  std::vector<std::string> words;  // the columns that were found and the guesses; empty: the file was a recording
};

// Whether a file may be a recording: it has an extension other than .json (models).
bool may_be_recording(const std::string& path);

// Converts a table of another program to a recording file in `folder` (engine/import); a recording stays as it is.
// Errors: those of read_recording or import_table; the new file cannot be written.
Result<ConvertedRecording> convert_recording(const std::string& path, const std::string& folder);

// The part from the row of least force between 60 % and 80 % of the rows on, where the tool is in air if it ever leaves
// the material there, is removed from `recording` and returned. Its name says which part it is. Empty for a recording
// of fewer than 100 rows, which stays as it is.
std::optional<Recording> take_test_part(Recording& recording);

// Limits the simulated hand to the forces, depths and speeds of the training data. Returns whether there is any force.
// Where no position is positive (a surface at negative positions), only the force is limited.
// Speeds are differences over at least 20 ms, to suppress encoder steps. The fastest 1 % are ignored as noise.
// The rows of a recording are not empty (read_recording).
bool limit_hand(const std::vector<Recording>& recordings, HandSettings& hand);

}  // namespace palpate
