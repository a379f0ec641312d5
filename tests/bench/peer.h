// What palpate-bench sets beside each other: Palpate's methods and, where they
// are installed, libraries that fit a function to scattered points.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "models/fit/fit.h"

namespace palpate::bench {

// d normalised features in, newtons out. One thread at a time.
using Function = std::function<double(const double* x)>;

struct PeerSetting {
  std::string text;  // for the reader
  // The function fitted to prepared.sites. Errors: what the library says.
  std::function<Result<Function>(const PreparedTraining& prepared)> fit;
};

// With several settings the one is taken that does best on strokes left out of
// the training.
struct Peer {
  std::string name;
  std::vector<PeerSetting> settings;
  // Fitted to so many of the sites, evenly spread; 0: to all.
  Eigen::Index most_sites = 0;
};

std::vector<Peer> palpate_peers();
// No function at all: 0 N and, with the trend, the trend alone.
Peer nothing_peer();
// Defined where CMake found the library.
std::vector<Peer> alglib_peers();
std::vector<Peer> dlib_peers();
std::vector<Peer> dlib_forest_peers();

}  // namespace palpate::bench
