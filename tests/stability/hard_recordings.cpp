// The recording cases of hard_cases.h.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "engine/base/random_stream.h"
#include "tests/stability/hard_cases.h"
#include "tests/stability/hard_methods.h"
#include "tests/stability/hard_outcome.h"
#include "tests/stability/hard_presses.h"

namespace palpate {
namespace {

struct RecordingCase {
  std::string name;
  Press training;
  Press held_out;
  TrainingRequest request = clean_request();
};

Press clean_press(const Path& path) { return press_along(path, even_times(kEvaluatedSeconds, kEvaluatedRate_Hz)); }

RecordingCase clean_case(const std::string& name) { return {name, clean_training(), clean_press(training_path(1))}; }

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

// One row in ten is lost, and a whole quarter of a second.
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
    cases.push_back(
        along(papers ? "forces near zero, the paper's recipe" : "forces near zero, weights 1/f", 0.02, 0.0));
    cases.back().request.weighting = Weighting::relative;
    if (papers) cases.back().request.reduction = Reduction::force;
    if (papers) cases.back().request.recipe = FitRecipe::paper_2009;
  }
  cases.push_back(with_forces("all forces zero", [](std::size_t, double) { return 0.0; }));
  std::fill(cases.back().held_out.true_N.begin(), cases.back().held_out.true_N.end(), 0.0);
  cases.push_back(clean_case("one outlier of 100 N"));
  const auto deepest =
      std::max_element(cases.back().training.recording.rows.begin(), cases.back().training.recording.rows.end(),
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

void run_recording_case(const RecordingCase& one, FeatureChoice choice, std::vector<HardCaseResult>& results) {
  TrainingRequest request = one.request;
  request.choice = choice;
  const std::string name = one.name + (choice == FeatureChoice::automatic ? ", features auto" : "");
  const FittedMethods fitted = fit_methods(name, one.training.recording, request);
  std::vector<OutcomeCounter> counters(fitted.models.size());
  evaluate_press(one.held_out, fitted.models, counters);
  for (HardCaseResult& result : fitted.finish(counters)) results.push_back(std::move(result));
}

}  // namespace

std::vector<HardCaseResult> run_hard_recordings(FeatureChoice choice) {
  std::vector<HardCaseResult> results;
  for (const RecordingCase& one : recording_cases()) run_recording_case(one, choice, results);
  return results;
}

}  // namespace palpate
