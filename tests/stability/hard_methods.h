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

// Depth, velocity and a low-pass; the surface as recorded: these are about numbers, not
// about where a surface lies.
TrainingRequest clean_request();

// The models, and one result for each method, in the order of methods(); those that were
// refused have no model.
struct FittedMethods {
  std::vector<std::shared_ptr<const FittedModel>> models;
  std::vector<std::size_t> at;  // of each model in `results`
  std::vector<HardCaseResult> results;

  // The results, with what `counters`, one for each model, have counted.
  std::vector<HardCaseResult> finish(const std::vector<OutcomeCounter>& counters) const;
};
FittedMethods fit_methods(const std::string& name, const Recording& recording, const TrainingRequest& request);

// Every tick of `press` in contact, for every model.
void evaluate_press(const Press& press, const std::vector<std::shared_ptr<const FittedModel>>& models,
                    std::vector<OutcomeCounter>& counters);

}  // namespace palpate
