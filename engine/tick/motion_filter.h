// The filters of motion_filter.inc in double precision, with four states. Exported models compile the same text.
// Thread guarantee: pure functions on a MotionState, wait-free.
#pragma once

#include <cmath>

namespace palpate::motion_filter {

using real = double;
#define R(x) (x)
#define SQRT std::sqrt
#define EXP std::exp
#define LOG std::log
#define MOTION_STATES 4
#include "engine/tick/motion_filter.inc"
#undef EACH_FILTER
#undef MOTION_FILTERS
#undef MOTION_STATES
#undef LOG
#undef EXP
#undef SQRT
#undef R

}  // namespace palpate::motion_filter
