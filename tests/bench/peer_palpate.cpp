// Palpate's own methods as peers of the others: the function alone, without
// trend, trust and clamp.
#include <memory>
#include <string>

#include "tests/bench/peer.h"

namespace palpate::bench {
namespace {

Result<Function> fit(const PreparedTraining& prepared, Method method) {
  MethodRequest request;
  request.method = method;
  Result<MethodFit> fitted = fit_method(prepared, request);
  if (!fitted) return fitted.error();
  if (fitted->data.grid) {
    const auto lookup = std::make_shared<const VoxelLookup>(*fitted->data.grid);
    return Function([lookup](const double* x) { return lookup->evaluate(x); });
  }
  const auto evaluator = std::make_shared<const RbfEvaluator>(*fitted->data.rbf);
  return Function([evaluator](const double* x) { return evaluator->evaluate(x); });
}

}  // namespace

std::vector<Peer> palpate_peers() {
  std::vector<Peer> peers;
  const auto add = [&](Method method, const char* name, const char* text) {
    peers.push_back(
        {name, {{text, [method](const PreparedTraining& prepared) { return fit(prepared, method); }}}});
  };
  add(Method::random, "palpate_random-100", "100 centres");
  add(Method::kdtree, "palpate_kdtree-100", "100 centres");
  add(Method::greedy, "palpate_greedy-100", "100 centres, 100 candidates a step");
  add(Method::direct, "palpate_direct", "all sites are centres, smoothing chosen by leaving out strokes");
  add(Method::voxel, "palpate_voxel", "25x11x11x11 grid (as `palpate fit` chooses it), filled from direct");
  return peers;
}

}  // namespace palpate::bench
