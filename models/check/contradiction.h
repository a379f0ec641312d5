// Detects two recordings of one set with different forces at the same depth, which no single model can render: another
// specimen, a preload, or a force zero.
//
// The recordings contradict each other if in four of five bins of their positions the central 90 % of their forces do
// not overlap, if the medians of their forces differ by more than two JND at the median bin, and if no shift of one
// against the other explains this (models/recordings/force_curve.h): a shift is another surface, which a fit corrects.
// Thread guarantee: slow side, pure.
#pragma once

#include <optional>

#include "engine/recording/recording.h"
#include "engine/tick/jnd.h"

namespace palpate {

struct Contradiction {
  double force_N = 0.0;      // the second minus the first, at the median bin
  double speed_ratio = 1.0;  // of the mean loading speeds, the faster over the slower: may explain the difference
};

std::optional<Contradiction> find_contradiction(const Recording& first, const Recording& second, const JndLine& jnd);

}  // namespace palpate
