// The recordings of hard_cases.h.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "engine/base/random_stream.h"
#include "tests/stability/hard_cases.h"
#include "tests/support/fitting.h"

namespace palpate::test {
namespace {

struct RecordingCase {
  std::string name;
  Press training;
  Press held_out;
  TrainingRequest request = clean_request();
};

RecordingCase moved(const std::string& name, double factor, double offset_m) {
  const auto press = [=](int variant, double seconds, double rate_Hz) {
    return press_into(*make_soft_block(), scaled(training_path(variant), factor, offset_m),
                      even_times(seconds, rate_Hz));
  };
  return {name, press(0, kTrainingSeconds, kTrainingRate_Hz), press(1, kEvaluatedSeconds, kEvaluatedRate_Hz)};
}

RecordingCase clean_case(const std::string& name) { return moved(name, 1.0, 0.0); }

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
  RecordingCase made = clean_case(name);
  made.training = press_into(*make_soft_block(), training_path(0), times_s);
  return made;
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
        moved(papers ? "forces near zero, the paper's recipe" : "forces near zero, weights 1/f", 0.02, 0.0));
    cases.back().request.weighting = Weighting::relative;
    if (papers) use_papers_recipe(cases.back().request);
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
  cases.push_back(moved("never leaves the surface", 0.4, 0.002));
  cases.push_back(moved("never touches", 1.0, -0.02));
  cases.push_back(moved("the tool stands still", 0.0, 0.003));
  return cases;
}

// Expects at least this share of the held-out press within the JND from every method, for common faults of a rig.
void run_cases(FeatureChoice choice, const std::set<std::string>& accurate, double least_within_jnd) {
  for (RecordingCase& one : recording_cases()) {
    one.request.choice = choice;
    std::vector<HardCase> cases = fit_methods(one.training.recording, one.request);
    evaluate_press(one.held_out, cases);
    expect_safe(one.name, cases);
    if (accurate.count(one.name) == 0) continue;
    for (const HardCase& of : cases) {
      EXPECT_GT(of.known, 0U) << one.name << ", " << of.method << ": " << of.refusal;
      EXPECT_GE(static_cast<double>(of.within), least_within_jnd * static_cast<double>(of.known))
          << one.name << ", " << of.method;
    }
  }
}

TEST(HardCases, EveryMethodIsSafeWithEveryRecording) {
  run_cases(FeatureChoice::scene,
            {"nothing wrong", "one outlier of 100 N", "20 % noise", "dropped samples", "10 Hz", "jittered time stamps",
             "never leaves the surface", "forces near zero, weights 1/f"},
            0.999);
}

TEST(HardCases, EveryMethodIsSafeWithEveryRecordingThatDecidesItsFeatures) {
  run_cases(FeatureChoice::automatic, {}, 0.0);
}

}  // namespace
}  // namespace palpate::test
