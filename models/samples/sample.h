// A sample: a row of a recording with the estimated motion of the tool.
// Thread guarantee: value types and pure functions, slow side.
#pragma once

#include <utility>
#include <vector>

#include "engine/recording/recording.h"
#include "engine/tick/motion_estimator.h"
#include "engine/tick/tool_sample.h"

namespace palpate {

// The maximum number of rows of a search.
inline constexpr std::size_t kSearchRows = 4000;

struct Sample {
  ToolSample tool;
  MotionEstimate motion;  // estimated from every row, before thinning
  double force_N = 0.0;
};

// Every n-th row, n = rows / most + 1 (integer division), so that at most `most` are left, with the motion estimated
// from all.
std::vector<Sample> thinned_rows(const Recording& recording, std::size_t most);
// The smallest and the largest position of at least one row.
std::pair<double, double> position_range_m(const std::vector<Sample>& rows);
// The median (the upper one of an even number); 0 for no values.
double median_of(std::vector<double> values);

// The index of the block of each row: kBlocks blocks of equal path length of the tool.
inline constexpr std::size_t kBlocks = 10;
std::vector<std::size_t> blocks_by_path(const std::vector<Sample>& rows);

}  // namespace palpate
