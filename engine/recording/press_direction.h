// Determines the signs of position and force of a recording from its samples: the force of a contact grows with the
// depth and is (nearly) zero at the other end.
//
// The mean force is computed for sixteenths of the range of positions. The shallow end is the one where the force is
// nearly zero; if an offset of the force hides that, it is the end where the force changes less. The sign of the
// position is right if the shallow end has the lower positions, that of the force if the force is larger at the deep
// end. The result is certain only with free air: a flat force at the shallow end, small relative to the deep end.
// Without free air, a material that softens, drags or yields can look like a flipped sign.
// Thread guarantee: pure function, slow side.
#pragma once

#include <vector>

#include "engine/recording/recording.h"

namespace palpate {

struct PressDirection {
  bool known = false;             // whether the signs could be determined
  bool certain = false;           // there is free air, so that no material explains a flipped sign
  bool position_flipped = false;  // position decreases with depth
  bool force_flipped = false;     // force is negative when the material pushes the tool out
  double shallow_force_N = 0.0;   // mean over the shallowest samples
  double deep_force_N = 0.0;
};

PressDirection find_press_direction(const std::vector<RecordingRow>& rows);

}  // namespace palpate
