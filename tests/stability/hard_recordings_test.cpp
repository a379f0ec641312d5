// The recordings of hard_cases.h.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "engine/base/random_stream.h"
#include "models/fit/fit.h"
#include "scenes/material/maxwell_block.h"
#include "tests/stability/hard_cases.h"

namespace palpate::test {
namespace {

constexpr double kTrainingSeconds = 5.0;
constexpr double kTrainingRate_Hz = 125.0;

// Up to about 2.5 N at 6 mm.
constexpr MaxwellParameters kSoft = {.elastic_linear_N_per_m = 300.0,
                                     .elastic_quadratic_N_per_m2 = 2e4,
                                     .viscosity_Ns_per_m2 = 500.0,
                                     .branches = {{{0.17, 100.0, 0.0}}}};

Press press_soft_block(const Path& path, const std::vector<double>& times_s) {
  MaxwellBlock block(kSoft);
  return press_into(block, path, times_s);
}

struct RecordingCase {
  std::string name;
  Press training;
  Press held_out;
  TrainingRequest request = clean_request();
};

RecordingCase moved(const std::string& name, double factor, double offset_m) {
  return {name,
          press_soft_block(scaled(training_path(0), factor, offset_m), even_times(kTrainingSeconds, kTrainingRate_Hz)),
          press_soft_block(scaled(training_path(1), factor, offset_m), even_times(4.0, 1000.0))};
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
  made.training = press_soft_block(training_path(0), times_s);
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
  cases.push_back(moved("forces near zero, weights 1/f", 0.02, 0.0));
  cases.back().request.weighting = Weighting::relative;
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

// `prepare` changes the request of every case. For the recordings in `accurate` 99.9 % of a held-out press must be
// within the JND.
void run_cases(void (*prepare)(TrainingRequest&), const std::set<std::string>& accurate = {}) {
  for (RecordingCase& one : recording_cases()) {
    prepare(one.request);
    std::vector<HardCase> cases = fit_methods(one.training.recording, one.request);
    evaluate_press(one.held_out, cases);
    expect_safe(one.name, cases);
    if (accurate.count(one.name) == 0) continue;
    for (const HardCase& of : cases) {
      EXPECT_GT(of.known, 0U) << one.name << ", " << of.method << ": " << of.refusal;
      EXPECT_GE(static_cast<double>(of.within), 0.999 * static_cast<double>(of.known)) << one.name << ", " << of.method;
    }
  }
}

// Common faults of a rig must not reduce the accuracy.
TEST(HardCases, EveryMethodIsSafeWithEveryRecording) {
  run_cases([](TrainingRequest&) {},
            {"nothing wrong", "one outlier of 100 N", "20 % noise", "dropped samples", "10 Hz", "jittered time stamps",
             "never leaves the surface", "forces near zero, weights 1/f"});
}

TEST(HardCases, EveryMethodIsSafeWithEveryRecordingThatDecidesItsFeatures) {
  run_cases([](TrainingRequest& request) { request.choice = FeatureChoice::automatic; });
}

// Without trend and trust, so that every force is that of the method itself. The other fits leave the correction out,
// because the trend describes this material.
TEST(HardCases, EveryMethodIsSafeWithEveryRecordingByTheRecipeOf2009) {
  run_cases([](TrainingRequest& request) { request = recipe_2009_request(request); });
}

}  // namespace
}  // namespace palpate::test
