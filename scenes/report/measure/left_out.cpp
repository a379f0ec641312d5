#include "scenes/report/measure/left_out.h"

#include <algorithm>

#include "scenes/report/measure/evaluator.h"
#include "scenes/report/measure/method_fitter.h"

namespace palpate {
namespace {

constexpr std::size_t kMostThirds = 3;      // of several recordings at most every third is left out
constexpr std::size_t kSmallestRecording = 1000;  // rows; less is not divided
constexpr double kLeftOutShare = 0.4;

// Every so-manieth recording.
LeftOutFold whole_ones(const std::vector<SharedRecording>& training, std::size_t fold) {
  const std::size_t every = std::min(kMostThirds, training.size());
  LeftOutFold result;
  for (std::size_t i = 0; i < training.size(); ++i) {
    if (i % every == (fold + 1) % every) result.left_out.push_back({training[i], kAlways});
    else result.train.push_back(training[i]);
  }
  return result;
}

// The end of a recording, or its beginning: in one piece, since a part that is trained on
// begins without the memory that the material has.
LeftOutFold piece_of(const Recording& recording, bool end) {
  const std::size_t rows = recording.rows.size();
  const double share = end ? 1.0 - kLeftOutShare : kLeftOutShare;
  const std::size_t cut = row_in_air(recording, static_cast<std::size_t>(share * static_cast<double>(rows)), rows / 10);
  const double cut_s = recording.rows[cut].time_s;
  LeftOutFold fold;
  fold.train.push_back(end ? rows_of(recording, 0, cut, recording.name) : rows_of(recording, cut, rows, recording.name));
  fold.left_out.push_back({std::make_shared<const Recording>(recording),
                           end ? Interval{cut_s, kAlways.high} : Interval{kAlways.low, cut_s}});
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
  if (training.size() == 1 && training.front()->rows.size() < kSmallestRecording) return folds;
  const std::size_t possible = training.size() == 1 ? 2 : std::min(kMostThirds, training.size());
  for (std::size_t f = 0; f < std::min(static_cast<std::size_t>(most), possible); ++f) {
    folds.push_back(training.size() == 1 ? piece_of(*training.front(), f == 0) : whole_ones(training, f));
  }
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
    for (const LeftOutPart& part : fold.left_out) {
      const auto errors = evaluator.evaluate(*part.recording, models, {}, part.seconds);
      if (!errors) return errors.error();
    }
  }
  if (!progress.next(0.0).may_continue(1.0)) return interrupted();
  std::vector<Evidence> errors(plan.models.size());
  const std::vector<Evidence> pooled = evaluator.pooled();
  for (std::size_t i = 0; i < candidates.size(); ++i) errors[candidates[i]] = pooled[i];
  return errors;
}

}  // namespace palpate
