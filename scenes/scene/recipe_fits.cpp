#include "scenes/scene/recipe_fits.h"

#include <chrono>

namespace palpate {

std::string model_name(Recipe recipe, const Method& method, int centres) {
  if (recipe == Recipe::no_force) return "no force";
  if (recipe == Recipe::position) return "position only";
  std::string name = recipe == Recipe::paper ? kPaperPrefix : "";
  name += method.name;
  if (method.can_take(kTakesCentres) && centres > 0) name.append("-").append(std::to_string(centres));
  return name;
}

RecipeFits::RecipeFits(std::vector<PreparedRecordingPointer> recordings, const Scene& scene)
    : recordings_(std::move(recordings)), request_(training_request(scene)) {}

Result<const PreparedTraining*> RecipeFits::prepare(Recipe recipe, const FitControl& control) {
  if (const auto found = prepared_.find(recipe); found != prepared_.end()) return &found->second;
  TrainingRequest request = recipe == Recipe::paper ? recipe_2009_request(request_) : request_;
  if (recipe == Recipe::position) {
    request.features = {FeatureSpec{}};
    request.choice = FeatureChoice::scene;
  }
  MotionSource source(recordings_);
  auto made = prepare_training(source, request, control);
  if (!made) return made.error();
  return &prepared_.emplace(recipe, std::move(*made)).first->second;
}

Result<RecipeFits::Fit> RecipeFits::fit(Recipe recipe, MethodRequest request, const FitControl& control) {
  const PreparedTraining& prepared = prepared_.at(recipe);
  if (!request.grid.empty()) request.grid.resize(prepared.common.features.size(), request.grid.back());
  const auto base = bases_.find({recipe, request.method->base});
  const bool has_base = base != bases_.end();
  const auto start = std::chrono::steady_clock::now();
  auto made = fit_method(prepared, request, control, has_base ? &base->second : nullptr);
  if (!made) return made.error();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  Fit fit{std::move(*made), elapsed.count() + (has_base ? base->second.seconds : 0.0)};
  // No base has centres or a grid, of which there can be several numbers.
  if (!request.method->can_take(kTakesCentres)) bases_.try_emplace({recipe, request.method}, fit);
  return fit;
}

}  // namespace palpate
