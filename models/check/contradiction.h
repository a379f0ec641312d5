// Whether two recordings of one set have different forces at the same depth, which no single model renders:
// another specimen, a preload, or a force zero.
//
// The depths that both reach are cut into sixty bins. Two recordings contradict each other when in four of five bins
// the middle 90 % of their forces do not overlap, whatever the tool did there, when the medians of their forces on
// the way in differ by more than two JND at the median bin, and when no shift of one against the other brings
// that below one JND: a shift is another surface, which a fit finds.
// Thread guarantee: slow side, pure.
#pragma once

#include <optional>

#include "engine/recording/recording.h"
#include "engine/tick/jnd.h"

namespace palpate {

struct Contradiction {
  double force_N = 0.0;      // the second less the first, at the median bin
  double speed_ratio = 1.0;  // of the way in, the faster over the slower: a material may do that
};

std::optional<Contradiction> find_contradiction(const Recording& first, const Recording& second, const JndLine& jnd);

}  // namespace palpate
