// Rows for the search for a surface: a recording thinned to what that needs.
// Thread guarantee: value types and pure functions, slow side.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "engine/recording/recording.h"
#include "engine/tick/motion_estimator.h"
#include "engine/tick/tool_sample.h"

namespace palpate {

// Rows that a search works on at most; thin longer recordings to these.
inline constexpr std::size_t kSearchRows = 4000;

struct SurfaceRow {
  ToolSample sample;
  MotionEstimate motion;  // by the estimator over every row, before thinning
  double force_N = 0.0;
};

// Every row up to a bound; beyond, every second one, then every fourth ... but none further
// apart than `coarsest_s`: then the rows are those of the beginning.
class GrowingStride {
 public:
  explicit GrowingStride(std::size_t most, double coarsest_s = std::numeric_limits<double>::infinity())
      : most_(most), coarsest_s_(coarsest_s) {}

  void add(const SurfaceRow& row);
  const std::vector<SurfaceRow>& rows() const { return rows_; }

 private:
  std::size_t most_;
  double coarsest_s_;
  std::size_t stride_ = 1;
  std::size_t seen_ = 0;
  std::vector<SurfaceRow> rows_;
};

// Every n-th row, at most `most` of them.
std::vector<SurfaceRow> thinned_rows(const std::vector<SurfaceRow>& rows, std::size_t most);
// Every row of a recording, or every n-th, at most `most` of them.
std::vector<SurfaceRow> all_rows(const Recording& recording);
std::vector<SurfaceRow> thinned_rows(const Recording& recording, std::size_t most);

// Which of `blocks` pieces of equal way of the tool each row is in.
std::vector<std::size_t> blocks_by_way(const std::vector<SurfaceRow>& rows, std::size_t blocks);

}  // namespace palpate
