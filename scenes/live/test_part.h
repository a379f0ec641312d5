// Sets apart the end of a recording as a test, for a user with a single recording.
// Thread guarantee: pure function.
#pragma once

#include <optional>

#include "engine/recording/recording.h"

namespace palpate {

// The part from the row of least force between 60 % and 80 % of the rows on, where the tool is in air if it ever leaves
// the material there, is removed from `recording` and returned. Its name says which part it is. Empty for a recording
// of fewer than 100 rows, which stays as it is.
std::optional<Recording> take_test_part(Recording& recording);

}  // namespace palpate
