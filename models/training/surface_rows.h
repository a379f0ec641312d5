// Rows for the search for a surface: a recording thinned to what that needs.
// Thread guarantee: value types and pure functions, slow side.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/recording/recording.h"
#include "engine/tick/motion_estimator.h"
#include "engine/tick/tool_sample.h"

namespace palpate {

struct SurfaceRow {
  ToolSample sample;
  MotionEstimate motion;  // by the estimator over every row, before thinning
  double force_N = 0.0;
};

// Every n-th row of a recording, at most `most` of them.
std::vector<SurfaceRow> thinned_rows(const Recording& recording, std::size_t most);

}  // namespace palpate
