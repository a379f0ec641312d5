// Models that were fitted to the virtual material of a scene when the program was built (ready_models_main.cpp), so
// that a window has them at its start.
//   FOLDER/SCENE/NAME.json    a model, as `palpate fit` writes it
//   FOLDER/SCENE/inputs.txt   what the fits depend on, beside the program itself, on which their build depends
// Thread guarantee: slow side (does I/O).
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "engine/base/result.h"
#include "models/fit/model_plan.h"
#include "models/model/fitted_model.h"
#include "scenes/scene/scene.h"

namespace palpate {

class ReadyModels {
 public:
  ReadyModels() = default;
  // Those of a session of this scene, whose fits have this seed. Empty if the inputs are others.
  ReadyModels(const std::string& folder, const Scene& scene, std::uint64_t seed);

  // Whether there is a model of this plan.
  bool has(const ModelPlan& plan) const;
  // Null if it cannot be read.
  std::shared_ptr<const FittedModel> read(const ModelPlan& plan) const;

 private:
  std::string file_of(const ModelPlan& plan) const { return folder_ + "/" + plan_name(plan) + ".json"; }
  std::string folder_;  // of the scene; empty: no models
};

// Fits the models with which a window of this scene may start, with seed 1. Errors: those of load_scene, the fits and
// save_model; the folder cannot be created.
Status make_ready_models(const std::string& folder, const std::string& scene);

}  // namespace palpate
