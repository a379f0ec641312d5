// The trend method: the viscoelastic trend of prepare_training without a correction. It is the smallest model and the
// baseline of every other method.
#include "models/correction/methods.h"

namespace palpate {

const Method kTrendMethod{
    .name = "trend",
    .label = "trend",
    .colour = 0xCC79A7,
    .expected_seconds = 0.01,
    .fit = [](const MethodTask&, const FitControl&) -> Result<FittedCorrection> { return FittedCorrection{}; },
};

}  // namespace palpate
