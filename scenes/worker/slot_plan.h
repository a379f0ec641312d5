// Plans of a session's models: how each is fitted, or from which file it is read. A session keeps each of its models in
// a numbered slot (scenes/live/session_models.h).
// Thread guarantee: slow side (reads files).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "models/model/fitted_model.h"
#include "scenes/scene/recipe_fits.h"

namespace palpate {

// The largest number of centres of the slider.
inline constexpr int kMostCentres = 200;

// A model file, or a method with a recipe, to be fitted to the scene's material.
struct SlotPlan {
  const Method* method = &kGreedyMethod;
  Recipe recipe = Recipe::palpate;
  int centres = 0;                                      // of a method with that option; 0: the method's default
  std::string path{};                                   // of a file; empty: the model is fitted
  std::shared_ptr<const FittedModel> loaded = nullptr;  // the model, if it exists already; plan_slots reads files
  bool of_this_material = false;                        // a file counts as this material, whatever its recordings

  bool is_file() const { return !path.empty(); }
};

// A named set of models to compare.
struct LineUp {
  const char* name;
  const char* help;  // one line
  std::vector<std::string> models;
};
// All line-ups; the first is the default of a window.
const std::vector<LineUp>& line_ups();
// Null when the name is unknown.
const LineUp* find_line_up(const std::string& name);

// The name of a slot until its model is ready.
std::string plan_name(const SlotPlan& plan);
// The method's name, or "position"; empty for a file.
std::string plan_method(const SlotPlan& plan);

// Makes plans from `models`, names of methods or model files; empty: all methods but the trend. A name may end in a
// number of centres ("greedy-10") where the method has that option, and begin with "2009-" for the paper's recipe.
// Model files are read. `position_only` adds a model with the depth as its only feature where the scene has a
// material. The direct interpolant is always added as the reference, except where all models are files and the scene
// has no virtual material. Errors: neither a method nor a file, a file that load_model refuses, a method in a scene
// without a material, more than kMaxModels models.
Result<std::vector<SlotPlan>> plan_slots(const Scene& scene, const std::vector<std::string>& models,
                                         bool position_only);

}  // namespace palpate
