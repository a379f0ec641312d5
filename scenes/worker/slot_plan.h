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
  method,    // fitted to a recording of the scene's material
  position,  // likewise, to the depth alone
  file,
};

// Up to which a model's number of centres is changed by hand.
inline constexpr int kMostCentres = 200;

struct SlotPlan {
  ModelOrigin origin = ModelOrigin::method;
  const Method* method = &kGreedyMethod;                // of a fit
  std::string path;                                     // of a file
  std::shared_ptr<const FittedModel> loaded = nullptr;  // of a file, which plan_slots reads
  int centres = 0;                                      // of a method that takes them; 0: as many as it takes by itself
  bool paper = false;                                   // by the paper's own recipe: 50 mN steps, rows weighted 1/f
};

// A set of models to compare, by name.
struct LineUp {
  const char* name;
  const char* help;  // one line
  std::vector<std::string> models;
};
// The first is the one to begin with.
const std::vector<LineUp>& line_ups();
// Null: there is none of that name.
const LineUp* find_line_up(const std::string& name);

// What to call it until there is a model with a name of its own.
std::string plan_name(const SlotPlan& plan);
// What a model of the paper's recipe has behind its name.
inline constexpr const char* kPaperMark = " '09";
// The method's name, or "position"; nothing for a file before it is read.
std::string plan_method(const SlotPlan& plan);

// `models`: methods or model files as asked for; none: the scene's default. A method that takes centres may
// say how many, "greedy-10", and "paper:" before it asks for the paper's recipe. Files are read here, so
// that a broken one is known before anything starts. In a scene with a material a model of position alone
// comes behind them when asked, and always the direct interpolant, the reference. Errors: neither a method
// nor a file, a file that load_model refuses, a method in a scene without a material, more than kMaxModels.
Result<std::vector<SlotPlan>> plan_slots(const Scene& scene, const std::vector<std::string>& models,
                                         bool position_only);

}  // namespace palpate
