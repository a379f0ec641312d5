// The training as each recipe prepares it, and fits upon it.
//
// Thread guarantee: slow side; the fits start threads themselves.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "models/fit/fit.h"
#include "scenes/report/data/plan.h"
#include "scenes/report/data/recordings.h"
#include "scenes/report/measure/weighted_progress.h"
#include "scenes/scene/scene.h"

namespace palpate {

// Shares of the progress, in expected seconds.
inline constexpr double kPrepareWeight = 1.0;
inline constexpr double kEvaluateWeight = 0.1;  // a model
// A method's base has been fitted before it.
double fit_weight(const MethodRequest& request);

struct Preparations {
  std::optional<PreparedTraining> paper;
  std::optional<PreparedTraining> palpate;

  const PreparedTraining& of(Rung rung) const { return rung == Rung::paper || !palpate ? *paper : *palpate; }
};

// Errors: those of prepare_training.
Result<Preparations> prepare_recipes(const std::vector<SharedRecording>& training, const Scene& scene,
                                     const ReportRecipe& recipe, Surface surface, WeightedProgress& progress);

class MethodFitter {
 public:
  struct Outcome {
    MethodFit fit;
    double seconds = 0.0;  // what its method's base took included
  };

  // `prepared` must live as long.
  explicit MethodFitter(const Preparations& prepared) : prepared_(prepared) {}

  // `model` above the lowest rung. The first fit of a rung and method serves as base of
  // others. Errors: those of fit_method, with the model's name.
  Result<Outcome> fit(const PlannedModel& model, const FitControl& control);

 private:
  const Preparations& prepared_;
  std::map<std::pair<Rung, const Method*>, Outcome> done_;
};

}  // namespace palpate
