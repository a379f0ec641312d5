#include "models/fit/choose_centres.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "engine/base/random_stream.h"

namespace palpate {

Result<CentreSequence> choose_random(const Sites& sites, const MethodRequest& request) {
  if (const Status status = validate_sites(sites); !status) return status.error();
  std::vector<Eigen::Index> order = distinct_sites(sites);
  const auto distinct = static_cast<Eigen::Index>(order.size());
  const Eigen::Index count = std::clamp<Eigen::Index>(request.centres, 0, distinct);
  SplitMix64 random(request.seed);
  Eigen::MatrixXd centres(sites.dimension(), count);
  for (Eigen::Index j = 0; j < count; ++j) {  // Fisher-Yates, the first `count` of it
    const auto left = static_cast<std::uint64_t>(distinct - j);
    const auto pick = static_cast<std::size_t>(j) + static_cast<std::size_t>(random.below(left));
    std::swap(order[static_cast<std::size_t>(j)], order[pick]);
    centres.col(j) = sites.points.col(order[static_cast<std::size_t>(j)]);
  }
  CentreSequence sequence = CentreSequence::growing(std::move(centres));
  if (count < request.centres) sequence.shortage = "there are no more distinct sites";
  return sequence;
}

const Method kRandomMethod{
    .name = "random",
    .label = "random",
    .colour = 0xE69F00,
    .takes = kTakesCentres | kTakesKernel | kTakesSeed,
    .expected_seconds =
        [](const MethodRequest& request) { return 0.08 + 0.02 * (0.01 * request.centres) * (0.01 * request.centres); },
    .fit = fit_chosen,
    .choose = [](const MethodTask& task, const FitControl&) { return choose_random(task.sites, task.request); },
};

}  // namespace palpate
