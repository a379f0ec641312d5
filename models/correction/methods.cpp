#include "models/correction/algebra.h"

#include <vector>

#include "models/correction/methods.h"

namespace palpate {

// Direct interpolation: every site is a centre, with the side condition of eq. 3 and the smoothing of the sites.
// Source: Hoever & Harders (2009), section 3, eqs. 2-8.

const Method kDirectMethod{
    .name = "direct",
    .colour = kNeutralColour,
    .takes = kTakesKernel,
    .expected_seconds = 1.0,
    .fit = [](const MethodTask& task, const FitControl& control) { return solve_direct(task.sites, control); },
};

// The random method: distinct sites drawn without replacement, the first of one permutation. It is the fastest method
// and the least accurate.
// Source: Hoever & Harders (2009), section 4.2.1.

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
    .colour = 0xE69F00,
    .takes = kTakesCentres | kTakesKernel | kTakesSeed,
    .expected_seconds = 0.1,
    .fit = fit_random,
};

// The trend without a correction: the smallest model, and the baseline of every other method.
const Method kTrendMethod{
    .name = "trend",
    .colour = 0xCC79A7,
    .expected_seconds = 0.01,
    .fit = [](const MethodTask&, const FitControl&) -> Result<FittedCorrection> { return FittedCorrection{}; },
};

const std::vector<const Method*>& methods() {
  static const std::vector<const Method*> table{&kTrendMethod,  &kDirectMethod, &kVoxelMethod,
                                                &kRandomMethod, &kKdTreeMethod, &kGreedyMethod};
  return table;
}

double expected_seconds(const Method& method) {
  return method.expected_seconds + (method.base == nullptr ? 0.0 : expected_seconds(*method.base));
}

Result<FittedCorrection> fit_correction(const Method& method, const MethodTask& task, const FitControl& control) {
  if (const Status status = validate_sites(task.sites); !status) return status.error();
  if (!control.may_continue(0.0)) return interrupted();
  if (method.base == nullptr || task.base != nullptr) return method.fit(task, control);
  const double share = expected_seconds(*method.base) / expected_seconds(method);
  const auto base = fit_correction(*method.base, task, control.part(0.0, share));
  if (!base) return base.error();
  MethodTask with_base = task;
  with_base.base = base->correction;
  return method.fit(with_base, control.part(share, 1.0));
}

Result<FittedCorrection> fit_centres(const MethodTask& task, const Eigen::MatrixXd& centres,
                                     const std::string& shortage) {
  FittedCorrection fitted = solve_weights(task.sites, centres);
  if (!fitted.function().weights.allFinite() || !fitted.function().tail.allFinite())
    return Error{"the weights of the centres could not be computed; check the recording for extreme values"};
  if (centres.cols() < task.centres)
    fitted.notes.push_back("only " + std::to_string(centres.cols()) + " centres: " + shortage);
  return fitted;
}

}  // namespace palpate
