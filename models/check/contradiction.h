// Detects two recordings of one set with different forces at the same depth, which no single model can render. The
// cause may be another specimen, a preload, or a force zero.
//
// The recordings contradict each other if the central 90 % of their forces do not overlap in four of five bins of their
// positions, if the median difference of their forces exceeds two JND, and if no shift of one against the other
// explains this (models/recordings/force_curve.h). A shift is another surface, which a fit corrects.
// Thread guarantee: slow side, pure.
#pragma once

#include <optional>

#include "engine/recording/recording.h"
#include "engine/tick/jnd.h"

namespace palpate {

struct Contradiction {
  double force_N = 0.0;      // median of the second minus the first
  double speed_ratio = 1.0;  // of the mean loading speeds, the faster over the slower: may explain the difference
};

std::optional<Contradiction> find_contradiction(const Recording& first, const Recording& second, const JndLine& jnd);

}  // namespace palpate
