// The recording and motion cases of hard_cases.h.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "engine/base/random_stream.h"
#include "engine/tick/replay.h"
#include "models/fit/fit.h"
#include "models/model/grid/grid_correction.h"
#include "models/model/rbf/rbf_correction.h"
#include "scenes/report/hard/hard_cases.h"
#include "scenes/report/hard/hard_outcome.h"
#include "scenes/report/hard/hard_presses.h"

namespace palpate {
namespace {

constexpr double kTrainingSeconds = 5.0;
constexpr double kTrainingRate_Hz = 125.0;
constexpr double kEvaluatedSeconds = 4.0;
constexpr double kEvaluatedRate_Hz = 1000.0;

TrainingRequest clean_request() {
  TrainingRequest request;
  request.scene = "hard case";
  // These are about numbers, not about where a surface lies.
  request.surface = Surface::recorded;
  request.features = {{FeatureKind::depth, 0.0, {}}, {FeatureKind::velocity, 0.0, {}},
                      {FeatureKind::lowpass_velocity, 0.17, {}}};
  return request;
}

struct RecordingCase {
  std::string name;
  Press training;
  Press held_out;
  TrainingRequest request = clean_request();
};

Press clean_training() { return press_along(training_path(0), even_times(kTrainingSeconds, kTrainingRate_Hz)); }

Press clean_press(const Path& path) { return press_along(path, even_times(kEvaluatedSeconds, kEvaluatedRate_Hz)); }

RecordingCase clean_case(const std::string& name) { return {name, clean_training(), clean_press(training_path(1))}; }

Path scaled(const Path& path, double factor, double offset_m) {
  return [=](double time_s) { return offset_m + factor * path(time_s); };
}

// The clean case with every force changed by `change(row number, force)`.
template <typename Change>
RecordingCase with_forces(const std::string& name, const Change& change) {
  RecordingCase made = clean_case(name);
  for (std::size_t i = 0; i < made.training.recording.rows.size(); ++i) {
    double& force_N = made.training.recording.rows[i].force_N;
    force_N = change(i, force_N);
  }
  return made;
}

// The clean case sampled at `times_s`.
RecordingCase sampled(const std::string& name, const std::vector<double>& times_s) {
  return {name, press_along(training_path(0), times_s), clean_press(training_path(1))};
}

RecordingCase along(const std::string& name, double factor, double offset_m) {
  return {name, press_along(scaled(training_path(0), factor, offset_m), even_times(kTrainingSeconds, kTrainingRate_Hz)),
          clean_press(scaled(training_path(1), factor, offset_m))};
}

std::vector<double> jittered_times() {
  RandomStream random(7, 5);
  std::vector<double> times_s = even_times(kTrainingSeconds, kTrainingRate_Hz);
  for (double& time_s : times_s) time_s += random.uniform(-0.45, 0.45) / kTrainingRate_Hz;
  return times_s;
}

// One row in ten is lost, and a quarter of a second altogether.
std::vector<double> dropped_times() {
  RandomStream random(7, 6);
  std::vector<double> kept_s;
  for (const double time_s : even_times(kTrainingSeconds, kTrainingRate_Hz)) {
    const bool gap = time_s > 1.2 && time_s < 1.45;
    if (random.index(10) != 0 && !gap) kept_s.push_back(time_s);
  }
  return kept_s;
}

std::vector<RecordingCase> recording_cases() {
  std::vector<RecordingCase> cases;
  cases.push_back(clean_case("nothing wrong"));
  RandomStream random(7, 4);
  for (const bool papers : {false, true}) {
    cases.push_back(along(papers ? "forces near zero, the paper's recipe" : "forces near zero, weights 1/f", 0.02, 0.0));
    cases.back().request.weighting = Weighting::relative;
    if (papers) cases.back().request.reduction = Reduction::force;
  }
  cases.push_back(with_forces("all forces zero", [](std::size_t, double) { return 0.0; }));
  std::fill(cases.back().held_out.true_N.begin(), cases.back().held_out.true_N.end(), 0.0);
  cases.push_back(clean_case("one outlier of 100 N"));
  const auto deepest = std::max_element(
      cases.back().training.recording.rows.begin(), cases.back().training.recording.rows.end(),
      [](const RecordingRow& a, const RecordingRow& b) { return a.position_m < b.position_m; });
  deepest->force_N = 100.0;
  cases.push_back(with_forces("20 % noise", [&](std::size_t, double f) { return f * (1.0 + 0.2 * random.normal()); }));
  cases.push_back(with_forces("a sensor that drifts by 0.2 N", [](std::size_t i, double f) {
    return f + 0.2 * static_cast<double>(i) / (kTrainingSeconds * kTrainingRate_Hz);
  }));
  cases.push_back(sampled("dropped samples", dropped_times()));
  cases.push_back(sampled("10 Hz", even_times(30.0, 10.0)));
  cases.push_back(sampled("20 kHz", even_times(0.4, 20000.0)));
  cases.push_back(sampled("jittered time stamps", jittered_times()));
  cases.push_back(along("never leaves the surface", 0.4, 0.002));
  cases.push_back(along("never touches", 1.0, -0.02));
  cases.push_back(along("the tool stands still", 0.0, 0.003));
  return cases;
}

using ModelPtr = std::shared_ptr<const FittedModel>;

// Every tick of `press` in contact, for every model.
void evaluate_press(const Press& press, const std::vector<ModelPtr>& models, std::vector<OutcomeCounter>& counters) {
  std::size_t row = 0;
  (void)replay(press.recording, ForceModels(models.begin(), models.end()),
               [&](const RecordingRow&, const TickSnapshot& snapshot, const HapticsTick&) {
                 const double truth_N = press.true_N[row++];
                 if (!snapshot.in_contact) return;
                 for (std::size_t i = 0; i < models.size(); ++i)
                   counters[i].add(snapshot.force_N[i], truth_N, 0.0,
                                   kForceMargin * models[i]->data().largest_force_N);
               });
}

Result<PreparedTraining> prepare(const RecordingCase& one) {
  MotionSource source({{"", std::make_shared<const Recording>(one.training.recording)}});
  return prepare_training(source, one.request);
}

Result<MethodFit> fit(const PreparedTraining& prepared, const Method& method) {
  MethodRequest request;
  request.method = &method;
  return fit_method(prepared, request);
}

HardCaseResult begin_result(const std::string& name, const Method& method, const FitReport& report) {
  HardCaseResult result;
  result.name = name;
  result.method = method.name;
  result.condition = report.condition;
  result.residual = report.residual_rms;
  result.smoothing = report.smoothing;
  return result;
}

void run_recording_case(const RecordingCase& one, std::vector<HardCaseResult>& results) {
  const Result<PreparedTraining> prepared = prepare(one);
  std::vector<ModelPtr> models;
  std::vector<std::size_t> at;  // of each model in `results`
  for (const Method* method : methods()) {
    HardCaseResult result = begin_result(one.name, *method, {});
    if (!prepared) {
      results.push_back(refused(std::move(result), prepared.error().message));
      continue;
    }
    const Result<MethodFit> fitted = fit(*prepared, *method);
    if (!fitted) {
      results.push_back(refused(std::move(result), fitted.error().message));
      continue;
    }
    at.push_back(results.size());
    results.push_back(begin_result(one.name, *method, fitted->report));
    models.push_back(std::make_shared<const FittedModel>(fitted->data));
  }
  std::vector<OutcomeCounter> counters(models.size());
  evaluate_press(one.held_out, models, counters);
  for (std::size_t i = 0; i < models.size(); ++i) results[at[i]] = counters[i].finish(std::move(results[at[i]]));
}

struct MotionCase {
  std::string name;
  Path path;
  double seconds = kEvaluatedSeconds;
};

std::vector<MotionCase> motion_cases() {
  const Path usual = training_path(1);
  const double stop_s = 0.1;
  return {
      {"half as deep again", scaled(usual, 1.5, 0.0)},
      {"three times as fast", [=](double t) { return usual(3.0 * t); }},
      {"a hold ten times as long", [](double t) { return 0.004 * std::tanh(5.0 * t); }, 20.0},
      {"contact made and broken at 20 Hz", [](double t) { return 0.003 * std::sin(2.0 * M_PI * 20.0 * t); }},
      {"a sudden stop", [=](double t) { return 0.05 * std::min(t, stop_s); }, 1.0},
      {"deeper without end", [](double t) { return 0.05 * t; }, 10.0},
  };
}

// Out along every axis, as far as numbers go, and what is no number.
OutcomeCounter sweep(const FittedModel& model) {
  OutcomeCounter counter;
  const ModelData& data = model.data();
  const double highest_N = kForceMargin * data.largest_force_N;
  const double infinity = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < data.features.size(); ++axis) {
    std::vector<double> x(data.offset.begin(), data.offset.end());
    const auto look = [&](double value) {
      x[axis] = value;
      counter.add_bounded(model.evaluate(x.data()).force_N, 0.0, highest_N);
    };
    for (const double sign : {-1.0, 1.0}) {
      for (double away = 1e-320; away < 1e308; away *= 3.0) look(sign * away);
      look(sign * infinity);
    }
    look(std::numeric_limits<double>::quiet_NaN());
  }
  return counter;
}

// Weights (or grid values) that overflow every sum.
ModelData with_huge_weights(ModelData data) {
  if (const RbfFunction* rbf = rbf_of(data.correction)) {
    RbfFunction huge = *rbf;
    for (Eigen::Index j = 0; j < huge.weights.size(); ++j) huge.weights[j] = j % 2 == 0 ? 1e300 : -1e300;
    data.correction = std::make_shared<const RbfCorrection>(std::move(huge));
  }
  if (const VoxelGrid* grid = grid_of(data.correction)) {
    VoxelGrid huge = *grid;
    for (std::size_t i = 0; i < huge.values_N.size(); ++i) huge.values_N[i] = i % 2 == 0 ? 1e300 : -1e300;
    data.correction = std::make_shared<const GridCorrection>(std::move(huge));
  }
  return data;
}

}  // namespace

std::vector<HardCaseResult> run_hard_recordings() {
  std::vector<HardCaseResult> results;
  for (const RecordingCase& one : recording_cases()) run_recording_case(one, results);
  return results;
}

std::vector<HardCaseResult> run_hard_motions() {
  std::vector<HardCaseResult> results;
  const Result<PreparedTraining> prepared = prepare(clean_case(""));
  std::vector<ModelPtr> models;
  std::vector<ModelPtr> huge;
  std::vector<FitReport> reports;
  for (const Method* method : methods()) {
    const Result<MethodFit> fitted = prepared ? fit(*prepared, *method) : prepared.error();
    if (!fitted) return {refused(begin_result("clean training", *method, {}), fitted.error().message)};
    models.push_back(std::make_shared<const FittedModel>(fitted->data));
    huge.push_back(std::make_shared<const FittedModel>(with_huge_weights(fitted->data)));
    reports.push_back(fitted->report);
  }
  const auto finish = [&](const std::string& name, const std::vector<OutcomeCounter>& counters) {
    for (std::size_t i = 0; i < methods().size(); ++i)
      results.push_back(counters[i].finish(begin_result(name, *methods()[i], reports[i])));
  };
  for (const MotionCase& one : motion_cases()) {
    std::vector<OutcomeCounter> counters(models.size());
    evaluate_press(press_along(one.path, even_times(one.seconds, kEvaluatedRate_Hz)), models, counters);
    finish(one.name, counters);
  }
  for (const bool weights : {false, true}) {
    std::vector<OutcomeCounter> counters;
    for (const ModelPtr& model : weights ? huge : models) counters.push_back(sweep(*model));
    finish(weights ? "weights of 1e300, to infinity on every axis" : "to infinity on every axis", counters);
  }
  return results;
}

std::vector<HardCaseResult> run_hard_cases() {
  std::vector<HardCaseResult> results = run_hard_sites();
  for (auto* more : {&run_hard_recordings, &run_hard_motions})
    for (HardCaseResult& result : (*more)()) results.push_back(std::move(result));
  return results;
}

}  // namespace palpate
