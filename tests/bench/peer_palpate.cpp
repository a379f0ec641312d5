// Palpate's methods as peers: the correction function alone, without trend, trust
// and limits.
#include <memory>
#include <string>

#include "tests/bench/peer.h"

namespace palpate::bench {
namespace {

Result<Function> fit(const PreparedTraining& prepared, const Method* method) {
  MethodRequest request;
  request.method = method;
  Result<MethodFit> fitted = fit_method(prepared, request);
  if (!fitted) return fitted.error();
  return Function([correction = fitted->data.correction](const double* x) { return correction->evaluate(x); });
}

}  // namespace

Peer nothing_peer() {
  return {"nothing", {{"0 N", [](const PreparedTraining&) { return Function([](const double*) { return 0.0; }); }}}};
}

std::vector<Peer> palpate_peers() {
  std::vector<Peer> peers;
  const auto add = [&](const Method* method, const char* name, const char* text) {
    peers.push_back({name, {{text, [method](const PreparedTraining& prepared) { return fit(prepared, method); }}}});
  };
  add(&kRandomMethod, "palpate_random-100", "100 centres");
  add(&kKdTreeMethod, "palpate_kdtree-100", "100 centres");
  add(&kGreedyMethod, "palpate_greedy-100", "100 centres, 100 candidates a step");
  add(&kDirectMethod, "palpate_direct", "all sites are centres, smoothing chosen by leaving out strokes");
  add(&kVoxelMethod, "palpate_voxel", "25x11x11x11 grid (as `palpate fit` chooses it), filled from direct");
  return peers;
}

}  // namespace palpate::bench
