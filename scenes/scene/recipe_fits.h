// The recipes by which the report and the window fit models, the names of these models, and their fits.
// Thread guarantee: slow side; one thread per object; fits start threads.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/fit_control.h"
#include "models/fit/fit.h"
#include "scenes/scene/scene.h"

namespace palpate {

// palpate   this program's defaults
// paper     the recipe of Hoever & Harders (2009), with two relaxation times fitted to the recordings
// position  this program's, with the depth as the only feature
// no_force  0 N, as a baseline of a report; it has no fit
enum class Recipe : std::uint8_t { palpate, paper, position, no_force };

inline constexpr const char* kPaperPrefix = "2009-";
// "greedy-100", "2009-greedy-100": the name of a model everywhere. `centres`: 0 where there are none.
std::string model_name(Recipe recipe, const Method& method, int centres);

// Fits of several models to the same recordings. Each recipe is prepared once, and a method starts from the fit of its
// base if that was made before.
class RecipeFits {
 public:
  RecipeFits(std::vector<PreparedRecordingPointer> recordings, const Scene& scene);

  // Prepares a recipe unless it is prepared already. Errors: those of prepare_training.
  Result<const PreparedTraining*> prepare(Recipe recipe, const FitControl& control);

  struct Fit : MethodFit {
    double seconds = 0.0;  // with its base, without the preparation
  };
  // The recipe has to be prepared. `request`: a grid is cut to the selected features. Errors: those of fit_method.
  Result<Fit> fit(Recipe recipe, MethodRequest request, const FitControl& control);

 private:
  std::vector<PreparedRecordingPointer> recordings_;
  TrainingRequest request_;
  std::map<Recipe, PreparedTraining> prepared_;
  std::map<std::pair<Recipe, const Method*>, Fit> bases_;
};

}  // namespace palpate
