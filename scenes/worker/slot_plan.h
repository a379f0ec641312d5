// What a session's models are made from, in the order of their slots.
// Thread guarantee: slow side (looks at files).
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
  method,    // fitted to a virtual recording of the scene's material
  position,  // likewise, to the depth alone
  file,
};

struct SlotPlan {
  ModelOrigin origin = ModelOrigin::method;
  const Method* method = &kGreedyMethod;  // of a fit
  std::string path;                       // of a file
  std::shared_ptr<const FittedModel> loaded = nullptr;  // of a file that has been read already
};

// What to call it until there is a model with a name of its own.
std::string plan_name(const SlotPlan& plan);
// The method's name, or "position"; nothing for a file before it is read.
std::string plan_method(const SlotPlan& plan);

// `models`: methods or model files as asked for; none: the scene's default. Files
// are read here, so that a broken one is known before anything starts. In a scene
// with a material a model of position alone comes behind them when asked, and always
// the direct interpolant, the reference. Errors: neither a method nor a file, a file
// that load_model refuses, a method in a scene without a material, more than
// kMaxModels in all.
Result<std::vector<SlotPlan>> plan_slots(const Scene& scene, const std::vector<std::string>& models,
                                         bool position_only);

}  // namespace palpate
