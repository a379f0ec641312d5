// The models that a report fits.
// Thread guarantee: pure functions.
#pragma once

#include <cstddef>
#include <vector>

#include "models/fit/model_plan.h"

namespace palpate {

// The main models, then other sizes. A method that starts from another method's fit (its base) follows it. `features`:
// number of the scene's features.
std::vector<ModelPlan> report_plans(bool quick, std::size_t features);

// Whether the plan has the default size, so that the model is a candidate of the ranking.
bool is_main(const ModelPlan& plan);
// Whether this is greedy on the measured force, the method that the paper recommends.
bool is_papers_greedy(const ModelPlan& plan);

}  // namespace palpate
