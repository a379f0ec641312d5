// The data of palpate-bench: one recording of the virtual silicone block, and
// smooth synthetic sites where their number or dimension varies. Made once,
// deterministic.
#pragma once

#include <functional>

#include "models/fit/fit.h"
#include "models/model/correction.h"

namespace palpate::bench {

// The number of sites of Hoever & Harders (2009).
inline constexpr Eigen::Index kPaperSites = 6850;

// The prepared recording: about 7,000 sites, four features.
const PreparedTraining& recorded();
// kPaperSites of its sites, evenly spread in time, and their thresholds.
const Sites& recorded_sites();
const Eigen::VectorXd& recorded_jnd_N();
// `centres` of these sites with random weights.
RbfFunction recorded_function(Eigen::Index centres);

// A smooth force at random points with 5 mN of noise; thresholds are 1 / row_scale.
Sites made_sites(int dimension, Eigen::Index count);

// Equally spaced nodes over the sites' bounding box.
VoxelGrid even_grid(const Sites& sites, const std::vector<int>& sizes);

// Peak memory during `work` minus memory in use before, in bytes; 0 if the
// system does not report it.
double peak_memory_of(const std::function<void()>& work);

}  // namespace palpate::bench
