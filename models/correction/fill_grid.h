// Fills a grid with the values of a function at its nodes.
// Thread guarantee: slow side.
// Source: Hoever & Harders (2009), section 3: precomputed force values on voxels.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "models/model/grid/voxel_grid.h"

namespace palpate {

// Sets out[i] to the value at points.col(i), for a batch of points, d x M.
using BatchFunction = std::function<void(const Eigen::MatrixXd& points, Eigen::VectorXd& out)>;

// Sets the values of a grid to those of the function at its nodes. Errors: interrupted. Slow side.
Status fill_grid(VoxelGrid& grid, const BatchFunction& function, const FitControl& control = {});

}  // namespace palpate
