// Every method fitted to one recording, and replayed. Internal to hard_cases.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "models/fit/fit.h"
#include "tests/stability/hard_cases.h"
#include "tests/stability/hard_outcome.h"
#include "tests/stability/hard_presses.h"

namespace palpate {

// Features: depth, velocity and a low-pass. The surface is as recorded, because these cases
// test numerics and not registration.
TrainingRequest clean_request();

// The models, and one result for each method, in the order of methods(). A method that
// refused the data has no model.
struct FittedMethods {
  std::vector<std::shared_ptr<const FittedModel>> models;
  std::vector<std::size_t> at;  // index of each model in `results`
  std::vector<HardCaseResult> results;

  // The results, completed from `counters` (one for each model).
  std::vector<HardCaseResult> finish(const std::vector<OutcomeCounter>& counters) const;
};
FittedMethods fit_methods(const std::string& name, const Recording& recording, const TrainingRequest& request);

// Adds the force of every model at every tick of `press` in contact to `counters`.
void evaluate_press(const Press& press, const std::vector<std::shared_ptr<const FittedModel>>& models,
                    std::vector<OutcomeCounter>& counters);

}  // namespace palpate
