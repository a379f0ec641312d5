#include "scenes/report/measure/method_fitter.h"

#include "scenes/report/measure/stopwatch.h"
#include "scenes/scene/training.h"

namespace palpate {
namespace {

Result<PreparedTraining> prepare_one(const std::vector<SharedRecording>& training, const TrainingRequest& request,
                                     const FitControl& control) {
  std::vector<MotionSource::Input> inputs;
  for (const SharedRecording& recording : training) inputs.push_back({"", recording});
  MotionSource source(std::move(inputs));
  return prepare_training(source, request, control);
}

}  // namespace

double fit_weight(const MethodRequest& request) { return request.method->expected_seconds(request); }

Result<Preparations> prepare_recipes(const std::vector<SharedRecording>& training, const Scene& scene,
                                     const ReportRecipe& recipe, Surface surface, WeightedProgress& progress) {
  Preparations prepared;
  TrainingRequest request = training_request(scene);
  request.surface = surface;
  if (recipe.palpate) {
    request.reduction = recipe.reduction;
    request.weighting = recipe.weighting;
    request.choice = recipe.choice;
    request.list = recipe.list;
    auto own = prepare_one(training, request, progress.next(kPrepareWeight));
    if (!own) return own.error();
    prepared.palpate = std::move(*own);
  }
  if (recipe.paper) {
    request.reduction = Reduction::force;
    request.weighting = Weighting::relative;
    request.choice = FeatureChoice::scene;
    auto papers = prepare_one(training, request, progress.next(kPrepareWeight));
    if (!papers) return papers.error();
    prepared.paper = std::move(*papers);
  }
  return prepared;
}

Result<MethodFitter::Outcome> MethodFitter::fit(const PlannedModel& model, const FitControl& control) {
  const auto base = done_.find({model.rung, model.request.method->base});
  const bool has_base = base != done_.end();
  const Stopwatch start;
  const PreparedTraining& prepared = prepared_.of(model.rung);
  MethodRequest request = model.request;
  // Left-out parts of a recording may support other features than the whole.
  if (!request.grid.empty()) request.grid.resize(prepared.common.features.size(), request.grid.back());
  auto fit = fit_method(prepared, request, control, has_base ? &base->second.fit : nullptr);
  if (!fit && fit.error().message == interrupted().message) return fit.error();
  if (!fit) return Error{model.name + ": " + fit.error().message};
  Outcome outcome{std::move(*fit), start.seconds() + (has_base ? base->second.seconds : 0.0)};
  done_.try_emplace({model.rung, model.request.method}, outcome);
  return outcome;
}

}  // namespace palpate
