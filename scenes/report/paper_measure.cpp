#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "engine/tick/sensor_identification.h"
#include "models/correction/methods.h"
#include "models/fit/fit.h"
#include "scenes/evaluation/evaluate.h"
#include "scenes/report/paper.h"
#include "scenes/report/recordings.h"
#include "scenes/scene/scene.h"

namespace palpate {
namespace {

constexpr double kQuickShare = 0.2;  // of the recordings
constexpr double kStep_N = 0.05;
const std::vector<int> kGrid{25, 11, 11, 11};
constexpr int kNodesOfFigure2 = 10;
// Bins with fewer samples are omitted.
constexpr std::uint64_t kReducedSamples = 20;
// Relaxation times of the fifth and sixth dimension of figure 2; the paper does not give them.
constexpr double kMoreTimes_s[] = {0.05, 4.0};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

ModelPlan plan_of(std::size_t which) {
  const Method* methods[kPaperMethods] = {&kVoxelMethod, &kRandomMethod, &kKdTreeMethod, &kGreedyMethod,
                                          &kGreedyMethod};
  return {.base = Base::force, .method = methods[which], .candidates = which == kGreedy20 ? 20 : 100, .grid = kGrid};
}

const char* const kNames[kPaperMethods] = {"grid", "random", "kD-tree", "greedy-20", "greedy-100"};
// greedy-20 has a shade of the colour of `greedy`.
std::uint32_t colour_of(std::size_t which) {
  return which == kGridOfAll ? kDirectMethod.colour : which == kGreedy20 ? 0xCC79A7 : plan_of(which).method->colour;
}

MethodTask task_of(std::size_t which, const Sites& sites, const Eigen::VectorXd& jnd_N) {
  MethodTask task{sites, jnd_N};
  task.candidates = plan_of(which).candidates;
  task.grid = kGrid;
  return task;
}

class PaperMeasurement {
 public:
  PaperMeasurement(bool quick, const FitControl& control) : quick_(quick), control_(control) {}

  Result<PaperData> run() {
    const auto scene = load_scene("silicone_block");
    if (!scene) return scene.error();
    scene_ = *scene;
    data_.jnd = scene_.jnd;
    for (const char* material : {"silicone", "maxwell"}) {
      if (const Status status = run_material(material); !status) return status.error();
    }
    return std::move(data_);
  }

 private:
  // Begins the next of the parts, and returns its control.
  FitControl part() {
    done_ += 1.0;
    const double parts = quick_ ? 30.0 : 60.0;
    return {
        [this, parts](double fraction) { return control_.may_continue(std::min(0.99, (done_ + fraction) / parts)); }};
  }

  // With the relaxation times of the scene, or identified ones.
  Result<PreparedTraining> prepare(const TrainingScene& scene, bool identified) {
    auto samples = make_samples({recordings_[0]}, scene.jnd, part());
    if (!samples) return samples.error();
    const ModelPlan plan{.base = Base::force, .features = identified ? FeatureChoice::automatic : FeatureChoice::scene};
    auto prepared = prepare_training(std::make_shared<const Samples>(std::move(*samples)), scene, plan, part());
    if (!prepared) return prepared.error();
    if (prepared->thinning_force_N != kStep_N)
      return Error{"the steps of the reduction grew to " + std::to_string(prepared->thinning_force_N) +
                   " N, expected 0.05 N as in the paper"};
    return prepared;
  }

  Status run_material(const std::string& material) {
    auto made = virtual_recordings(material, quick_ ? kQuickShare : 1.0);
    if (!made) return made.error();
    recordings_ = std::move(*made);
    for (const bool fitted : {false, true}) {
      if (fitted && quick_) continue;
      const auto prepared = prepare(training_scene(scene_), fitted);  // the scene's are the paper's, 0.17 and 1.27 s
      if (!prepared) return prepared.error();
      PaperRun run{material,
                   fitted,
                   relaxation_times_s(prepared->common.features),
                   recordings_[0]->recording.rows.size(),
                   recordings_[1]->recording.rows.size(),
                   static_cast<std::uint64_t>(prepared->sites.count()),
                   {}};
      if (const Status status = measure_run(std::move(run), *prepared); !status) return status;
      if (data_.runs.size() > 1) continue;
      if (const Status status = time_sites(*prepared); !status) return status;
      if (const Status status = time_dimensions(); !status) return status;
    }
    return {};
  }

  Status measure_run(PaperRun run, const PreparedTraining& prepared) {
    std::vector<ModelPointer> models;
    std::vector<EvaluatedModel> evaluated;
    for (std::size_t which = 0; which < kPaperMethods; ++which) {
      const auto start = std::chrono::steady_clock::now();
      auto fit = fit_method(prepared, plan_of(which), part());
      if (!fit) return Error{run.material + ", " + kNames[which] + ": " + fit.error().message};
      run.models.push_back({kNames[which], colour_of(which), seconds_since(start), {}, {}});
      models.push_back(std::make_shared<const FittedModel>(std::move(fit->data)));
      evaluated.push_back({models.back(), data_.jnd});
    }
    EvaluationRequest as_recorded;
    as_recorded.move_surface = false;
    const auto tested = evaluate(rows_of(recordings_[1]->recording), evaluated, as_recorded);
    if (!tested) return tested.error();
    const std::vector<ModelTiming> times = time_models(models, {tested->timing});
    for (std::size_t i = 0; i < models.size(); ++i) {
      ErrorSummary& errors = run.models[i].errors;
      errors = tested->models[i].as_recorded.summary();
      std::erase_if(errors.bins, [](const ForceBin& bin) { return bin.force_N.count() < kReducedSamples; });
      run.models[i].time = times[i];
    }
    data_.runs.push_back(std::move(run));
    return {};
  }

  Status time_sites(const PreparedTraining& prepared) {
    const Eigen::Index all = prepared.sites.count();
    for (const double share :
         quick_ ? std::vector<double>{0.25, 0.5, 1.0} : std::vector<double>{0.125, 0.25, 0.5, 1.0}) {
      const Sites some = even_subset(prepared.sites, static_cast<Eigen::Index>(share * static_cast<double>(all)));
      const Eigen::VectorXd jnd_N = some.target_N.unaryExpr([&](double force_N) { return data_.jnd.at(force_N); });
      FitTimes times{static_cast<std::size_t>(some.count()), {}};
      for (std::size_t which = 0; which < kPaperMethods; ++which) {
        const auto start = std::chrono::steady_clock::now();
        const auto fit = fit_correction(*plan_of(which).method, task_of(which, some, jnd_N), part());
        if (!fit) return fit.error();
        times.seconds.push_back(seconds_since(start));
      }
      data_.by_sites.push_back(std::move(times));
    }
    return {};
  }

  Status time_dimensions() {
    std::vector<FeatureSpec> features = scene_.features;
    for (const double time_s : kMoreTimes_s) features.push_back({FeatureKind::lowpass_velocity, time_s, {}});
    for (std::size_t d = 1; d <= (quick_ ? std::size_t{4} : features.size()); ++d) {
      TrainingScene scene = training_scene(scene_);
      scene.features.assign(features.begin(), features.begin() + static_cast<std::ptrdiff_t>(d));
      const auto prepared = prepare(scene, false);
      if (!prepared) return prepared.error();
      const Eigen::VectorXd jnd_N = site_thresholds(*prepared);
      auto start = std::chrono::steady_clock::now();
      const auto solved = fit_correction(kDirectMethod, {prepared->sites, jnd_N}, part());
      if (!solved) return solved.error();
      DimensionTimes times{d, seconds_since(start), 0.0};
      MethodTask asked{prepared->sites, jnd_N};
      asked.grid.assign(d, kNodesOfFigure2);
      asked.base = solved->correction;
      start = std::chrono::steady_clock::now();
      const auto grid = fit_correction(kVoxelMethod, asked, part());
      if (!grid) return grid.error();
      times.grid_s = seconds_since(start);
      data_.by_dimension.push_back(times);
    }
    return {};
  }

  bool quick_;
  const FitControl& control_;
  double done_ = 0.0;
  Scene scene_;
  PaperData data_;
  std::vector<PreparedRecordingPointer> recordings_;  // to train and to test
};

}  // namespace

Result<PaperData> measure_paper(bool quick, const FitControl& control) {
  return PaperMeasurement(quick, control).run();
}

}  // namespace palpate
