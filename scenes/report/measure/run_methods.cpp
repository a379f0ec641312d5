#include "scenes/report/measure/run_methods.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "engine/tick/replay.h"
#include "models/surface/surface_search.h"
#include "scenes/report/measure/coverage_finder.h"
#include "scenes/report/measure/evaluator.h"
#include "scenes/report/measure/left_out.h"
#include "scenes/report/measure/method_fitter.h"
#include "scenes/report/measure/no_force.h"
#include "scenes/report/measure/recommendation.h"
#include "scenes/report/measure/scaling.h"
#include "scenes/report/measure/trace_finder.h"
#include "scenes/report/measure/weighted_progress.h"

namespace palpate {
namespace {

constexpr double kSitesWeight = 8.0;
constexpr double kDimensionWeight = 10.0;

double total_weight(const RecordingSet& recordings, const ReportPlan& plan) {
  const double prepare = kPrepareWeight * ((plan.recipe.paper ? 1.0 : 0.0) + (plan.recipe.palpate ? 1.0 : 0.0));
  double fold = prepare;
  double left_out = prepare;
  for (const PlannedModel& model : plan.models) {
    fold += fit_weight(model.request) + 2.0 * kEvaluateWeight;
    if (is_candidate(model, plan.quick)) left_out += fit_weight(model.request) + kEvaluateWeight;
  }
  for (const PlannedModel& model : plan.repeated) {
    fold += static_cast<double>(plan.seeds.size()) * (fit_weight(model.request) + kEvaluateWeight);
  }
  return fold * static_cast<double>(recordings.folds.size()) + left_out * plan.left_out_folds + kSitesWeight +
         kDimensionWeight;
}

// Feature vectors as `model` meets them in the test recordings, to time it on.
FeatureSample sample_features(const RecordingSet& recordings, const Fold& fold, const ModelPointer& model) {
  FeatureSample sample;
  for (const std::size_t index : fold.test) {
    const auto replayed = replay(*recordings.all[index], {model},
                                 [&](const RecordingRow&, const TickSnapshot& snapshot, const HapticsTick& tick) {
                                   if (snapshot.in_contact) sample.add(tick.features_of(0));
                                 });
    static_cast<void>(replayed);  // one model is never too many
  }
  return sample;
}

double largest_force_N(const RecordingSet& recordings) {
  double largest = 0.0;
  for (const RecordingFacts& facts : recordings.facts) largest = std::max(largest, facts.largest_force_N);
  return largest;
}

// Where the surface of a tested recording is for the models; 0 where that cannot be told.
double surface_of_models(const Recording& recording, const std::vector<ModelPointer>& models, const JndLine& jnd) {
  return locate_surface(thinned_rows(recording, kSearchRows), models, jnd).offset_m;
}

class Run {
 public:
  Run(const RecordingSet& recordings, const Scene& scene, const ReportPlan& plan, const FitControl& control)
      : recordings_(recordings),
        scene_(scene),
        plan_(plan),
        progress_(control, total_weight(recordings, plan)),
        evaluator_(plan.models.size(), scene.jnd),
        moved_evaluator_(plan.models.size(), scene.jnd),
        seed_evaluator_(plan.repeated.size() * plan.seeds.size(), scene.jnd),
        floor_(scene.jnd),
        trace_(scene.jnd, counting(plan)),
        coverage_(scene.jnd, main_names(plan), reference(plan), largest_force_N(recordings)) {}

  Result<ReportData> all() {
    begin();
    for (std::size_t fold = 0; fold < recordings_.folds.size(); ++fold) {
      if (const Status status = run_fold(static_cast<int>(fold)); !status) return status.error();
    }
    finish_models();
    // With k folds every training stroke was left out once already.
    if (!recordings_.cross_validated) {
      auto left_out = left_out_errors(registered_, scene_, plan_, progress_);
      if (!left_out) return left_out.error();
      for (std::size_t i = 0; i < left_out->size(); ++i) data_.models[i].left_out = (*left_out)[i];
    }
    data_.recommendation = recommend(data_.models, data_.coverage.features.size());
    return std::move(data_);
  }

 private:
  static std::vector<std::string> main_names(const ReportPlan& plan) {
    std::vector<std::string> names;
    for (const PlannedModel& model : plan.models) {
      if (model.main) names.push_back(model.name);
    }
    return names;
  }

  // The worst seconds are those of the models that try their best.
  static std::vector<bool> counting(const ReportPlan& plan) {
    std::vector<bool> counts;
    for (const PlannedModel& model : plan.models) {
      if (model.main) counts.push_back(model.rung == (plan.recipe.palpate ? Rung::palpate : Rung::paper));
    }
    return counts;
  }

  static std::size_t reference(const ReportPlan& plan) { return main_names(plan).size() - 1; }

  void begin() {
    data_.scene = scene_.name;
    data_.jnd = scene_.jnd;
    data_.virtual_recordings = recordings_.virtual_recordings;
    data_.folds = recordings_.cross_validated ? static_cast<int>(recordings_.folds.size()) : 0;
    data_.recordings = recordings_.facts;
    for (const PlannedModel& model : plan_.models) {
      ModelResult result;
      result.plan = model;
      data_.models.push_back(std::move(result));
    }
  }

  Status run_fold(int number) {
    const Fold& fold = recordings_.folds[static_cast<std::size_t>(number)];
    std::vector<SharedRecording> training;
    for (const std::size_t index : fold.train) training.push_back(recordings_.all[index]);
    const Surface surface = recordings_.at_own_surface ? Surface::recorded : Surface::automatic;
    const auto prepared = prepare_recipes(training, scene_, plan_.recipe, surface, progress_);
    if (!prepared) return prepared.error();
    const PreparedTraining& own = prepared->of(Rung::palpate);
    if (number == 0) {
      remember_relaxation(own);
      data_.worth = own.selection.worth;
      registered_ = at_own_surfaces(training, own.common.provenance);
    }
    coverage_.add_sites(own.set);
    auto models = fit_models(number, *prepared);
    if (!models) return models.error();
    auto repeated = fit_repeated(*prepared);
    if (!repeated) return repeated.error();
    if (const Status status = evaluate(fold, *models, *repeated); !status) return status;
    const bool last = number + 1 == static_cast<int>(recordings_.folds.size());
    if (!last) return {};
    time_models(fold, *models);
    return time_scaling(own);
  }

  void remember_relaxation(const PreparedTraining& prepared) {
    for (const RelaxationTime& time : prepared.common.provenance.relaxation_times) {
      data_.relaxation_times.push_back(three_digits(time.time_s));
    }
  }

  Result<std::vector<ModelPointer>> fit_models(int fold, const Preparations& prepared) {
    std::vector<ModelPointer> models;
    MethodFitter fitter(prepared);
    for (ModelResult& result : data_.models) {
      const PlannedModel& plan = result.plan;
      if (plan.rung == Rung::no_force) {
        models.push_back(std::make_shared<const NoForce>(prepared.of(Rung::palpate).set.features));
        continue;
      }
      auto outcome = fitter.fit(plan, progress_.next(fit_weight(plan.request)));
      if (!outcome) return outcome.error();
      MethodFit& fit = outcome->fit;
      const PreparedTraining& own = prepared.of(plan.rung);
      result.fit_seconds += outcome->seconds / static_cast<double>(recordings_.folds.size());
      result.health.push_back({fold, fit.report, own.common.provenance.samples, own.set.sites.size(),
                               fit.data.provenance.training_within_jnd});
      auto model = std::make_shared<const FittedModel>(std::move(fit.data));
      result.size = model->centre_count();
      models.push_back(model);
      name_by_size(result, *model);
      data_.fitted[plan.name] = model;
    }
    return models;
  }

  // What was made, not what was asked for: no more centres than there are sites.
  static void name_by_size(ModelResult& result, const FittedModel& model) {
    PlannedModel& plan = result.plan;
    const Method& method = *plan.request.method;
    const std::string prefix = plan.rung == Rung::paper ? "paper-" : "";
    if (plan.main && method.can_take(kTakesGrid)) plan.name = prefix + model.name();
    if (method.can_take(kTakesCentres) && result.size < plan.request.centres) {
      plan.name = prefix + method.name + "-" + std::to_string(result.size);
      if (plan.few_candidates()) {
        plan.name += "-of-" + std::to_string(plan.request.candidates);
      }
    }
  }

  Result<std::vector<ModelPointer>> fit_repeated(const Preparations& prepared) {
    std::vector<ModelPointer> models;
    for (const PlannedModel& model : plan_.repeated) {
      for (const std::uint64_t seed : plan_.seeds) {
        MethodRequest request = model.request;
        request.seed = seed;
        auto fit = fit_method(prepared.of(model.rung), request, progress_.next(fit_weight(request)));
        if (!fit) return fit.error();
        models.push_back(std::make_shared<const FittedModel>(std::move(fit->data)));
      }
    }
    return models;
  }

  Status evaluate(const Fold& fold, const std::vector<ModelPointer>& models,
                  const std::vector<ModelPointer>& repeated) {
    const std::vector<ModelPointer> main(models.begin(), models.begin() + static_cast<std::ptrdiff_t>(main_models(data_)));
    for (const std::size_t index : fold.test) {
      const Recording& recording = *recordings_.all[index];
      const double share = kEvaluateWeight / static_cast<double>(fold.test.size());
      const auto errors = evaluator_.evaluate(recording, models, progress_.next(share * static_cast<double>(models.size())));
      if (!errors) return errors.error();
      data_.test_names.push_back(recording.name);
      data_.floors.push_back(recordings_.facts[index].noise);
      floor_.add(recording);
      for (std::size_t i = 0; i < errors->size(); ++i) data_.models[i].per_recording.push_back((*errors)[i]);
      if (const Status status = evaluate_moved(recording, models, main, share); !status) return status;
      const auto again =
          seed_evaluator_.evaluate(recording, repeated, progress_.next(share * static_cast<double>(repeated.size())));
      if (!again) return again.error();
      if (const Status status = trace_.search(recording, main); !status) return status;
      if (const Status status = coverage_.search(recording, main); !status) return status;
    }
    return {};
  }

  // The main models of the upper rung say together where the surface is, for all.
  Status evaluate_moved(const Recording& recording, const std::vector<ModelPointer>& models,
                        const std::vector<ModelPointer>& main, double share) {
    const std::vector<bool> counts = counting(plan_);
    std::vector<ModelPointer> upper;
    for (std::size_t i = 0; i < main.size(); ++i) {
      if (counts[i]) upper.push_back(main[i]);
    }
    const double offset_m = surface_of_models(recording, upper, scene_.jnd);
    data_.surface_offset_m.push_back(offset_m);
    const auto errors = moved_evaluator_.evaluate(with_correction(recording, {offset_m, 0.0}), models,
                                                  progress_.next(share * static_cast<double>(models.size())));
    if (!errors) return errors.error();
    for (std::size_t i = 0; i < errors->size(); ++i) data_.models[i].per_recording_moved.push_back((*errors)[i]);
    return {};
  }

  void time_models(const Fold& fold, const std::vector<ModelPointer>& models) {
    std::map<std::string, FeatureSample> samples;  // by the features that a model takes
    for (std::size_t i = 0; i < models.size(); ++i) {
      if (data_.models[i].plan.rung == Rung::no_force) continue;
      auto [at, fresh] = samples.try_emplace(feature_key(models[i]->features()));
      if (fresh) at->second = sample_features(recordings_, fold, models[i]);
      data_.models[i].time = time_model(*models[i], at->second);
    }
  }

  static std::string feature_key(const std::vector<FeatureSpec>& features) {
    std::string key;
    for (const FeatureSpec& spec : features) {
      key += feature_name(spec) + ",";
    }
    return key;
  }

  Status time_scaling(const PreparedTraining& prepared) {
    auto sites = time_against_sites(prepared, plan_.most_sites, plan_.site_halvings, progress_.next(kSitesWeight));
    if (!sites) return sites.error();
    data_.sites_time = std::move(*sites);
    auto dimensions = time_against_dimension(prepared.sites, plan_.most_dimensions, plan_.dimension_sites,
                                             progress_.next(kDimensionWeight));
    if (!dimensions) return dimensions.error();
    data_.dimension_time = std::move(*dimensions);
    data_.dimension_sites = std::min<std::uint64_t>(plan_.dimension_sites, prepared.set.sites.size());
    return {};
  }

  void finish_models() {
    const std::vector<Evidence> pooled = evaluator_.pooled();
    const std::vector<Evidence> moved = moved_evaluator_.pooled();
    for (std::size_t i = 0; i < pooled.size(); ++i) {
      data_.models[i].pooled = pooled[i];
      data_.models[i].pooled_moved = moved[i];
    }
    const std::vector<Evidence> seeds = seed_evaluator_.pooled();
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      data_.seeds.push_back(
          {plan_.repeated[i / plan_.seeds.size()], plan_.seeds[i % plan_.seeds.size()], seeds[i]});
    }
    data_.pooled_floor = floor_.result();
    data_.trace = trace_.worst();
    data_.coverage = coverage_.result();
    for (std::size_t i = 0; i < main_models(data_); ++i) data_.models[i].bins = coverage_.bins(i);
    for (std::size_t i = 0; i < plan_.models.size(); ++i) {
      const std::string& fitted = data_.models[i].plan.name;
      for (CoverageErrors& errors : data_.coverage.errors) {
        if (errors.model == plan_.models[i].name) errors.model = fitted;
      }
      if (data_.coverage.reference == plan_.models[i].name) data_.coverage.reference = fitted;
    }
  }

  const RecordingSet& recordings_;
  const Scene& scene_;
  const ReportPlan& plan_;
  WeightedProgress progress_;
  ReplayEvaluator evaluator_;
  ReplayEvaluator moved_evaluator_;
  ReplayEvaluator seed_evaluator_;
  NoiseFloorFinder floor_;
  TraceFinder trace_;
  CoverageFinder coverage_;
  std::vector<SharedRecording> registered_;  // the training, every surface at 0
  ReportData data_;
};

}  // namespace

Result<ReportData> run_methods(const RecordingSet& recordings, const Scene& scene, const ReportPlan& plan,
                               const FitControl& control) {
  return Run(recordings, scene, plan, control).all();
}

}  // namespace palpate
