// The limits of the simulated hand in a session of recordings.
// Thread guarantee: pure function.
#pragma once

#include <vector>

#include "devices/virtual/hand_motion.h"
#include "engine/recording/recording.h"

namespace palpate {

// Limits the simulated hand to the forces, depths and speeds of the training data. Returns whether there is any force.
// Where no position is positive (a surface at negative positions), only the force is limited.
// Speeds are differences over at least 20 ms, to suppress encoder steps. The fastest 1 % are ignored as noise.
// The rows of a recording are not empty (read_recording).
bool limit_hand(const std::vector<Recording>& recordings, HandSettings& hand);

}  // namespace palpate
