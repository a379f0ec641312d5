// Direct interpolation: every site is a centre, with the side condition of eq. 3 and the smoothing of the sites.
// Source: Hoever & Harders (2009), section 3, eqs. 2-8.
#include <utility>

#include "models/correction/methods.h"
#include "models/correction/solve_weights.h"

namespace palpate {

const Method kDirectMethod{
    .name = "direct",
    .label = "direct",
    .colour = kNeutralColour,
    .takes = kTakesKernel,
    .expected_seconds = 3.0,
    .fit = [](const MethodTask& task, const FitControl& control) -> Result<FittedCorrection> {
      auto solved = solve_direct(task.sites, control);
      if (!solved) return solved.error();
      return FittedCorrection{std::make_shared<const RbfCorrection>(std::move(solved->function)),
                              {},
                              solved->rank,
                              solved->condition_number};
    },
};

}  // namespace palpate
