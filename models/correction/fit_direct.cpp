// Direct interpolation: every site is a centre, with the side condition of eq. 3 and the smoothing of the sites.
// Source: Hoever & Harders (2009), section 3, eqs. 2-8.
#include "models/correction/algebra.h"
#include "models/correction/methods.h"

namespace palpate {

const Method kDirectMethod{
    .name = "direct",
    .label = "direct",
    .colour = kNeutralColour,
    .takes = kTakesKernel,
    .expected_seconds = 3.0,
    .fit = [](const MethodTask& task, const FitControl& control) { return solve_direct(task.sites, control); },
};

}  // namespace palpate
