// The models that a session is asked for: plans that are fitted to the scene's material, and model files. A session
// keeps each of its models in a numbered slot (scenes/live/session_models.h). Thread guarantee: slow side (reads
// files).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "models/fit/model_plan.h"
#include "models/model/fitted_model.h"
#include "scenes/scene/scene.h"

namespace palpate {

// The largest number of centres of the slider.
inline constexpr int kMostCentres = 200;

struct ModelRequest {
  ModelPlan plan;
  std::string path{};                                   // of a file; empty: the plan is fitted
  std::shared_ptr<const FittedModel> loaded = nullptr;  // the model, if it exists already; requested_models reads files
  bool of_this_material = false;                        // a file counts as this material, whatever its recordings

  bool is_file() const { return !path.empty(); }
};

struct LineUp {
  const char* name;
  const char* help;  // one line
  std::vector<std::string> models;
};
// All line-ups; the first is the default of a window, of the report's first table and of the main job.
const std::vector<LineUp>& line_ups();
const LineUp* find_line_up(const std::string& name);

// Models with differences from obvious to unnoticeable, for the game of the exhibit.
const std::vector<std::string>& exhibit_models();

// The name of a model until it is ready.
std::string request_name(const ModelRequest& request);

// Makes requests from `models`, names of models or model files; empty: the first line-up. Model files are read.
// Errors: neither a model nor a file, a file that load_model refuses, a plan in a scene without a material, more than
// kMaxModels models.
Result<std::vector<ModelRequest>> requested_models(const Scene& scene, const std::vector<std::string>& models);

}  // namespace palpate
