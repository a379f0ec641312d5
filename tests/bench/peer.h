// The methods that palpate-bench compares: Palpate's (peer_bench.cpp) and, where installed,
// libraries that fit a function to scattered points.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "models/fit/fit.h"

namespace palpate::bench {

// d normalised features in, newtons out. One thread at a time.
using Function = std::function<double(const double* x)>;

struct PeerSetting {
  std::string text;  // description for the table
  // Returns the function fitted to prepared.sites, or the error of the library.
  std::function<Result<Function>(const PreparedTraining& prepared)> fit;
};

// Of several settings the one with the smallest cross-validation error (by strokes) is
// used.
struct Peer {
  std::string name;
  std::vector<PeerSetting> settings;
  // The maximum number of sites, evenly spread; 0: all.
  Eigen::Index most_sites = 0;
};

// Defined if CMake found the library.
std::vector<Peer> alglib_peers();
std::vector<Peer> dlib_peers();

}  // namespace palpate::bench
