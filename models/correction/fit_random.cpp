// The random method: distinct sites drawn without replacement, the first of one permutation. It is the fastest method
// and the least accurate.
// Source: Hoever & Harders (2009), section 4.2.1.
#include <vector>

#include "models/correction/methods.h"

namespace palpate {
namespace {

Result<FittedCorrection> fit_random(const MethodTask& task, const FitControl&) {
  std::vector<Eigen::Index> order = distinct_sites(task.sites);
  SplitMix64 random(task.seed);
  order.resize(draw_first(order, task.centres, random));
  return fit_centres(task, task.sites.points(Eigen::all, order), "there are no more distinct sites");
}

}  // namespace

const Method kRandomMethod{
    .name = "random",
    .label = "random",
    .colour = 0xE69F00,
    .takes = kTakesCentres | kTakesKernel | kTakesSeed,
    .expected_seconds = 0.1,
    .fit = fit_random,
};

}  // namespace palpate
