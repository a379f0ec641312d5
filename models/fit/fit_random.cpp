// The random method: distinct sites drawn without replacement, the first of one permutation. It is the fastest method
// and the least accurate.
// Source: Hoever & Harders (2009), section 4.2.1.
#include <vector>

#include "models/fit/methods.h"

namespace palpate {
namespace {

Result<CentreSequence> choose_random(const MethodTask& task, const FitControl&) {
  const MethodRequest& request = task.request;
  std::vector<Eigen::Index> order = distinct_sites(task.sites);
  SplitMix64 random(request.seed);
  order.resize(draw_first(order, request.centres, random));
  CentreSequence sequence = CentreSequence::growing(task.sites.points(Eigen::all, order));
  if (sequence.most() < request.centres) sequence.shortage = "there are no more distinct sites";
  return sequence;
}

}  // namespace

const Method kRandomMethod{
    .name = "random",
    .label = "random",
    .colour = 0xE69F00,
    .takes = kTakesCentres | kTakesKernel | kTakesSeed,
    .expected_seconds =
        [](const MethodRequest& request) { return 0.08 + 0.02 * (0.01 * request.centres) * (0.01 * request.centres); },
    .choose = choose_random,
};

}  // namespace palpate
