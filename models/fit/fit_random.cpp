#include "models/fit/fit_random.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/random_stream.h"
#include "models/fit/methods.h"
#include "models/model/rbf/rbf_correction.h"
#include "models/solve/solve_weights.h"

namespace palpate {

Result<CentreSequence> choose_random(const Sites& sites, const RandomOptions& options) {
  if (const Status status = validate_sites(sites); !status) return status.error();
  std::vector<Eigen::Index> order = distinct_sites(sites);
  const auto distinct = static_cast<Eigen::Index>(order.size());
  const Eigen::Index count = std::clamp<Eigen::Index>(options.centres, 0, distinct);
  SplitMix64 random(options.seed);
  Eigen::MatrixXd centres(sites.dimension(), count);
  for (Eigen::Index j = 0; j < count; ++j) {  // Fisher-Yates, the first `count` of it
    const auto left = static_cast<std::uint64_t>(distinct - j);
    const auto pick = static_cast<std::size_t>(j) + static_cast<std::size_t>(random.below(left));
    std::swap(order[static_cast<std::size_t>(j)], order[pick]);
    centres.col(j) = sites.points.col(order[static_cast<std::size_t>(j)]);
  }
  CentreSequence sequence = CentreSequence::growing(std::move(centres));
  if (count < options.centres) sequence.shortage = "there are no more distinct sites";
  return sequence;
}

Result<FittedRbf> fit_random(const Sites& sites, const RandomOptions& options, const FitControl& control) {
  const auto sequence = choose_random(sites, options);
  if (!sequence) return sequence.error();
  return solve_largest(sites, options.kernel, *sequence, options.centres, control);
}

namespace {

Result<CentreSequence> random_sequence(const MethodTask& task, const FitControl&) {
  return choose_random(task.sites, {task.request.kernel, task.request.centres, task.request.seed});
}

Result<FittedCorrection> random_correction(const MethodTask& task, const FitControl& control) {
  const MethodRequest& request = task.request;
  auto fitted = fit_random(task.sites, {request.kernel, request.centres, request.seed}, control);
  if (!fitted) return fitted.error();
  return FittedCorrection{std::make_shared<const RbfCorrection>(std::move(fitted->function)), std::move(fitted->report),
                          std::to_string(request.centres)};
}

}  // namespace

const Method kRandomMethod{
    .name = "random",
    .label = "random",
    .colour = 0xE69F00,
    .takes = kTakesCentres | kTakesKernel | kTakesSeed,
    .expected_seconds =
        [](const MethodRequest& request) { return 0.08 + 0.02 * (0.01 * request.centres) * (0.01 * request.centres); },
    .fit = random_correction,
    .choose = random_sequence,
};

}  // namespace palpate
