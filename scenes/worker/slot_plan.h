// Plans of a session's models: how each is fitted, or from which file it is read. A session keeps each of its models in
// a numbered slot (scenes/live/session_models.h).
// Thread guarantee: slow side (reads files).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "models/fit/fit.h"
#include "scenes/scene/scene.h"

namespace palpate {

enum class ModelOrigin : std::uint8_t {
  method,    // fitted to the scene's material
  position,  // fitted to it with the depth as the only feature
  file,
};

// The largest number of centres of the slider.
inline constexpr int kMostCentres = 200;

struct SlotPlan {
  ModelOrigin origin = ModelOrigin::method;
  const Method* method = &kGreedyMethod;                // unless the model is from a file
  std::string path;                                     // of a file
  std::shared_ptr<const FittedModel> loaded = nullptr;  // the model, if it exists already; plan_slots reads files
  int centres = 0;                                      // of a method with that option; 0: the method's default
  bool paper = false;                                   // the paper's recipe: samples every 50 mN, rows weighted 1/f
  bool of_this_material = false;                        // a file counts as this material, whatever its recordings
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
// Suffix of the name of a model that was fitted by the paper's recipe.
inline constexpr const char* kPaperMark = " '09";
// The method's name, or "position"; empty for a file.
std::string plan_method(const SlotPlan& plan);

// Makes plans from `models`, names of methods or model files; empty: the scene's default models. A name may end in a
// number of centres ("greedy-10") where the method has that option, and begin with "paper:" for the paper's recipe.
// Model files are read. `position_only` adds a model with the depth as its only feature where the scene has a
// material. The direct interpolant is always added as the reference, except where all models are files and the scene
// has no virtual material. Errors: neither a method nor a file, a file that load_model refuses, a method in a scene
// without a material, more than kMaxModels models.
Result<std::vector<SlotPlan>> plan_slots(const Scene& scene, const std::vector<std::string>& models,
                                         bool position_only);

}  // namespace palpate
