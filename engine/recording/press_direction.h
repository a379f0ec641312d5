// Which way round position and force of a recording are, from the samples alone:
// the force of a contact grows with the depth and is (nearly) zero at the other end.
//
// The mean force is taken over sixteenths of the range of positions. The end whose
// force is (nearly) zero is the shallow one; where an offset of the force hides that,
// the end where the force changes less. Position is right when the shallow end is the
// low one, force is right when it is larger at the deep end. Certain is only what free air
// says: at the shallow end the force is flat, and small against that at the deep end. A
// material that softens, drags or yields looks like a flipped sign without it.
// Thread guarantee: slow side; one thread per object.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "engine/recording/recording.h"

namespace palpate {

struct PressDirection {
  bool known = false;             // false: the data do not say
  bool certain = false;           // no material can look like this the right way round
  bool position_flipped = false;  // deeper is more negative
  bool force_flipped = false;     // pushing out is negative
  double shallow_force_N = 0.0;   // mean over the shallowest samples
  double deep_force_N = 0.0;
};

PressDirection find_press_direction(const std::vector<RecordingRow>& rows);

}  // namespace palpate
