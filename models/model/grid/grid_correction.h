// A grid of forces as the correction of a model: the data for files and fits, and the look-up for the tick.
// Thread guarantee: immutable.
#pragma once

#include "models/model/correction.h"
#include "models/model/grid/voxel_grid.h"

namespace palpate {

class GridCorrection final : public Correction {
 public:
  explicit GridCorrection(VoxelGrid grid);

  double evaluate(const double* u) const noexcept override { return lookup_.evaluate(u); }
  int size() const noexcept override { return static_cast<int>(grid_.node_count()); }
  // grid {nodes, values_N}: first the axes, then the values, one line for each run along the last axis.
  FileFields file_fields() const override;

  const VoxelGrid& grid() const noexcept { return grid_; }

 private:
  VoxelGrid grid_;
  VoxelLookup lookup_;
};

// The grid of a correction of this kind, else null.
const VoxelGrid* grid_of(const CorrectionPtr& correction);

}  // namespace palpate
