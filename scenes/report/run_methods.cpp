#include "scenes/report/run_methods.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <utility>

#include "engine/tick/replay.h"
#include "models/training/surface_search.h"
#include "scenes/report/judge.h"
#include "scenes/report/scaling.h"
#include "scenes/report/steps.h"
#include "scenes/scene/training.h"

namespace palpate {
namespace {

using Clock = std::chrono::steady_clock;

// A method's base has been fitted before it.
double own_seconds(const MethodRequest& request) { return request.method->expected_seconds(request); }

constexpr double kPrepareWeight = 1.0;
constexpr double kJudgeWeight = 0.1;  // a model
constexpr double kSitesWeight = 8.0;
constexpr double kDimensionWeight = 10.0;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double total_weight(const RecordingSet& recordings, const ReportPlan& plan) {
  double fold = kPrepareWeight;
  for (const PlannedModel& model : plan.models) fold += own_seconds(model.request) + kJudgeWeight;
  for (const PlannedModel& model : plan.repeated) {
    fold += static_cast<double>(plan.seeds.size()) * (own_seconds(model.request) + kJudgeWeight);
  }
  return fold * static_cast<double>(recordings.folds.size()) + kSitesWeight + kDimensionWeight;
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

class Run {
 public:
  Run(const RecordingSet& recordings, const Scene& scene, const ReportPlan& plan, const FitControl& control)
      : recordings_(recordings),
        scene_(scene),
        plan_(plan),
        steps_(control, total_weight(recordings, plan)),
        jury_(plan.models.size(), scene.jnd),
        moved_jury_(plan.models.size(), scene.jnd),
        seed_jury_(plan.repeated.size() * plan.seeds.size(), scene.jnd),
        trace_(scene.jnd),
        coverage_(scene.jnd, main_names(plan), largest_force_N(recordings)) {}

  Result<ReportData> all() {
    begin();
    for (std::size_t fold = 0; fold < recordings_.folds.size(); ++fold) {
      if (const Status status = run_fold(static_cast<int>(fold)); !status) return status.error();
    }
    finish_models();
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

  Result<PreparedTraining> prepare(const Fold& fold) {
    std::vector<MotionSource::Input> inputs;
    for (const std::size_t index : fold.train) inputs.push_back({"", recordings_.all[index]});
    MotionSource source(std::move(inputs));
    return prepare_training(source, training_request(scene_), steps_.next(kPrepareWeight));
  }

  Status run_fold(int number) {
    const Fold& fold = recordings_.folds[static_cast<std::size_t>(number)];
    const auto prepared = prepare(fold);
    if (!prepared) return prepared.error();
    if (number == 0) remember_relaxation(*prepared);
    coverage_.add_sites(prepared->set);
    auto models = fit_models(number, *prepared);
    if (!models) return models.error();
    auto repeated = fit_repeated(*prepared);
    if (!repeated) return repeated.error();
    if (const Status status = judge(fold, *models, *repeated); !status) return status;
    const bool last = number + 1 == static_cast<int>(recordings_.folds.size());
    if (!last) return {};
    time_models(fold, *models);
    return time_scaling(*prepared);
  }

  void remember_relaxation(const PreparedTraining& prepared) {
    for (const RelaxationTime& time : prepared.common.provenance.relaxation_times) {
      data_.relaxation_times.push_back(three_digits(time.time_s));
    }
  }

  Result<std::vector<ModelPointer>> fit_models(int fold, const PreparedTraining& prepared) {
    std::vector<ModelPointer> models;
    std::map<const Method*, std::pair<MethodFit, double>> done;  // the main fit of each method, and its seconds
    for (ModelResult& result : data_.models) {
      const MethodRequest& request = result.plan.request;
      const auto base = done.find(request.method->base);
      const bool has_base = base != done.end();
      const auto start = Clock::now();
      auto fit = fit_method(prepared, request, steps_.next(own_seconds(request)),
                            has_base ? &base->second.first : nullptr);
      if (!fit) return fit.error();
      const double seconds = seconds_since(start) + (has_base ? base->second.second : 0.0);
      result.fit_seconds += seconds / static_cast<double>(recordings_.folds.size());
      result.health.push_back({fold, fit->report, prepared.common.provenance.samples, prepared.set.sites.size(),
                               fit->data.provenance.training_within_jnd});
      done.try_emplace(request.method, *fit, seconds);
      models.push_back(std::make_shared<const FittedModel>(std::move(fit->data)));
      result.size = models.back()->centre_count();
      if (result.plan.main && request.method->can_take(kTakesGrid)) result.plan.name = models.back()->name();
    }
    return models;
  }

  Result<std::vector<ModelPointer>> fit_repeated(const PreparedTraining& prepared) {
    std::vector<ModelPointer> models;
    for (const PlannedModel& model : plan_.repeated) {
      for (const std::uint64_t seed : plan_.seeds) {
        MethodRequest request = model.request;
        request.seed = seed;
        auto fit = fit_method(prepared, request, steps_.next(own_seconds(request)));
        if (!fit) return fit.error();
        models.push_back(std::make_shared<const FittedModel>(std::move(fit->data)));
      }
    }
    return models;
  }

  Status judge(const Fold& fold, const std::vector<ModelPointer>& models, const std::vector<ModelPointer>& repeated) {
    const std::vector<ModelPointer> main(models.begin(), models.begin() + static_cast<std::ptrdiff_t>(main_models(data_)));
    for (const std::size_t index : fold.test) {
      const Recording& recording = *recordings_.all[index];
      const double share = kJudgeWeight / static_cast<double>(fold.test.size());
      const auto errors = jury_.judge(recording, models, steps_.next(share * static_cast<double>(models.size())));
      if (!errors) return errors.error();
      data_.test_names.push_back(recording.name);
      for (std::size_t i = 0; i < errors->size(); ++i) data_.models[i].per_recording.push_back((*errors)[i]);
      if (const Status status = judge_moved(recording, models, main); !status) return status;
      const auto again =
          seed_jury_.judge(recording, repeated, steps_.next(share * static_cast<double>(repeated.size())));
      if (!again) return again.error();
      if (const Status status = trace_.look_at(recording, main); !status) return status;
      if (const Status status = coverage_.look_at(recording, main); !status) return status;
    }
    return {};
  }

  // The main models say together where the surface is.
  Status judge_moved(const Recording& recording, const std::vector<ModelPointer>& models,
                     const std::vector<ModelPointer>& main) {
    const SurfaceLocation surface =
        locate_surface(thinned_rows(recording, kSearchRows), {main.begin(), main.end()}, scene_.jnd);
    data_.surface_offset_m.push_back(surface.offset_m);
    const auto errors = moved_jury_.judge(recording, models, {}, surface.offset_m);
    if (!errors) return errors.error();
    for (std::size_t i = 0; i < errors->size(); ++i) data_.models[i].per_recording_moved.push_back((*errors)[i]);
    return {};
  }

  void time_models(const Fold& fold, const std::vector<ModelPointer>& models) {
    const FeatureSample sample = sample_features(recordings_, fold, models.front());
    for (std::size_t i = 0; i < models.size(); ++i) data_.models[i].time = time_model(*models[i], sample);
  }

  Status time_scaling(const PreparedTraining& prepared) {
    auto sites = time_against_sites(prepared, plan_.site_counts, steps_.next(kSitesWeight));
    if (!sites) return sites.error();
    data_.sites_time = std::move(*sites);
    auto dimensions = time_against_dimension(prepared.sites, plan_.most_dimensions, plan_.dimension_sites,
                                             steps_.next(kDimensionWeight));
    if (!dimensions) return dimensions.error();
    data_.dimension_time = std::move(*dimensions);
    data_.dimension_sites = std::min<std::uint64_t>(plan_.dimension_sites, prepared.set.sites.size());
    return {};
  }

  void finish_models() {
    const std::vector<ErrorSummary> pooled = jury_.pooled();
    for (std::size_t i = 0; i < pooled.size(); ++i) data_.models[i].pooled = pooled[i];
    const std::vector<ErrorSummary> moved = moved_jury_.pooled();
    for (std::size_t i = 0; i < moved.size(); ++i) data_.models[i].pooled_moved = moved[i];
    const std::vector<ErrorSummary> seeds = seed_jury_.pooled();
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      data_.seeds.push_back(
          {plan_.repeated[i / plan_.seeds.size()], plan_.seeds[i % plan_.seeds.size()], seeds[i]});
    }
    data_.trace = trace_.worst();
    data_.coverage = coverage_.result();
    for (std::size_t i = 0; i < main_models(data_); ++i) data_.models[i].bins = coverage_.bins(i);
    for (CoverageErrors& errors : data_.coverage.errors) {
      for (std::size_t i = 0; i < plan_.models.size(); ++i) {
        if (errors.model == plan_.models[i].name) errors.model = data_.models[i].plan.name;
      }
    }
  }

  const RecordingSet& recordings_;
  const Scene& scene_;
  const ReportPlan& plan_;
  Steps steps_;
  Jury jury_;
  Jury moved_jury_;
  Jury seed_jury_;
  TraceFinder trace_;
  CoverageFinder coverage_;
  ReportData data_;
};

}  // namespace

Result<ReportData> run_methods(const RecordingSet& recordings, const Scene& scene, const ReportPlan& plan,
                               const FitControl& control) {
  return Run(recordings, scene, plan, control).all();
}

}  // namespace palpate
