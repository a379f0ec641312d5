#include "scenes/report/left_out.h"

#include <algorithm>

#include "scenes/report/evaluator.h"
#include "scenes/report/method_fitter.h"

namespace palpate {
namespace {

constexpr std::size_t kWholeFrom = 3;  // recordings: whole ones are left out

// Every other part of every recording.
LeftOutFold every_other(const std::vector<std::vector<SharedRecording>>& parts, std::size_t odd) {
  LeftOutFold fold;
  for (const auto& recording : parts) {
    for (std::size_t k = 0; k < recording.size(); ++k) (k % 2 == odd ? fold.left_out : fold.train).push_back(recording[k]);
  }
  return fold;
}

LeftOutFold every_third(const std::vector<SharedRecording>& training, std::size_t third) {
  LeftOutFold fold;
  for (std::size_t i = 0; i < training.size(); ++i) {
    (i % kWholeFrom == third ? fold.left_out : fold.train).push_back(training[i]);
  }
  return fold;
}

// Of one fold; no models where there is too little to learn from.
std::vector<ModelPointer> fit_candidates(const Preparations& prepared, const ReportPlan& plan,
                                         const std::vector<std::size_t>& candidates, WeightedProgress& progress) {
  MethodFitter fitter(prepared);
  std::vector<ModelPointer> models;
  for (const std::size_t i : candidates) {
    auto outcome = fitter.fit(plan.models[i], progress.next(fit_weight(plan.models[i].request)));
    if (!outcome) return {};
    models.push_back(std::make_shared<const FittedModel>(std::move(outcome->fit.data)));
  }
  return models;
}

}  // namespace

std::vector<LeftOutFold> left_out_folds(const std::vector<SharedRecording>& training, int most) {
  std::vector<LeftOutFold> folds;
  const auto count = static_cast<std::size_t>(most);
  if (training.size() >= kWholeFrom) {
    for (std::size_t f = 0; f < std::min(count, kWholeFrom); ++f) folds.push_back(every_third(training, (f + 1) % kWholeFrom));
    return folds;
  }
  std::vector<std::vector<SharedRecording>> parts;
  for (const SharedRecording& recording : training) {
    auto pieces = cut_into_parts(*recording);
    if (!pieces) return {};
    parts.push_back(std::move(*pieces));
  }
  // The odd parts first: training on the first, third and fifth has more to learn from.
  for (std::size_t f = 0; f < std::min<std::size_t>(count, 2); ++f) folds.push_back(every_other(parts, 1 - f));
  return folds;
}

std::vector<SharedRecording> at_own_surfaces(const std::vector<SharedRecording>& training,
                                             const Provenance& provenance) {
  std::vector<SharedRecording> moved;
  for (const SharedRecording& recording : training) {
    const auto surface = std::find_if(provenance.surfaces.begin(), provenance.surfaces.end(),
                                      [&](const RecordingSurface& one) { return one.name == recording->name; });
    moved.push_back(surface == provenance.surfaces.end()
                        ? recording
                        : std::make_shared<const Recording>(
                              with_correction(*recording, {surface->offset_m, surface->force_zero_N})));
  }
  return moved;
}

Result<std::vector<Evidence>> left_out_errors(const std::vector<SharedRecording>& training, const Scene& scene,
                                              const ReportPlan& plan, WeightedProgress& progress) {
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < plan.models.size(); ++i) {
    if (is_candidate(plan.models[i], plan.quick)) candidates.push_back(i);
  }
  ReplayEvaluator evaluator(candidates.size(), scene.jnd);
  for (const LeftOutFold& fold : left_out_folds(training, plan.left_out_folds)) {
    // Too little to learn from, or to tell by: nothing can be said from this fold.
    const auto prepared = prepare_recipes(fold.train, scene, plan.recipe, Surface::recorded, progress);
    if (!prepared) continue;
    const std::vector<ModelPointer> models = fit_candidates(*prepared, plan, candidates, progress);
    if (models.empty()) continue;
    for (const SharedRecording& recording : fold.left_out) {
      if (const auto errors = evaluator.evaluate(*recording, models); !errors) return errors.error();
    }
  }
  if (!progress.next(0.0).go_on(1.0)) return interrupted();
  std::vector<Evidence> errors(plan.models.size());
  const std::vector<Evidence> pooled = evaluator.pooled();
  for (std::size_t i = 0; i < candidates.size(); ++i) errors[candidates[i]] = pooled[i];
  return errors;
}

}  // namespace palpate
