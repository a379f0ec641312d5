// Fills a grid with the values of a function at its nodes.
// Thread guarantee: slow side.
// Source: Hoever & Harders (2009), section 3: precomputed force values on voxels.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "models/model/grid/voxel_grid.h"

namespace palpate {

// Fills out[i] for the points, d x M, of a batch.
using BatchFunction = std::function<void(const Eigen::MatrixXd& points, Eigen::VectorXd& out)>;

// More nodes than this (800 MB) are refused.
inline constexpr std::size_t kMostVoxels = 100'000'000;

// Sets every value of a grid with nodes to the function there. Errors: too
// many nodes; interrupted. Off the tick.
Status fill_grid(VoxelGrid& grid, const BatchFunction& function, const FitControl& control = {});

}  // namespace palpate
