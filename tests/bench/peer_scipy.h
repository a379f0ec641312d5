// scipy's RBFInterpolator, run by Debian's Python through peer_scipy.py.
#pragma once

#include <map>
#include <string>

#include "engine/base/result.h"
#include "tests/bench/peer_data.h"

namespace palpate::bench {

struct ScipyPeer {
  PeerResult result;
  double query_s = 0.0;
};

inline constexpr const char* kScipyPeers[] = {"scipy_all_sites", "scipy_50_neighbours"};

// Peers by name. The script runs once. Errors: the script failed, or its output cannot be read.
const Result<std::map<std::string, ScipyPeer>>& scipy_peers();

}  // namespace palpate::bench
