#include "tests/stability/hard_cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/tick/replay.h"

namespace palpate::test {

void HardCase::add(double value_N, double low_N, double high_N) {
  ++count;
  if (!(value_N >= low_N && value_N <= high_N)) ++unsafe;  // NaN is unsafe
}

void HardCase::add(double value_N, double truth_N, double low_N, double high_N) {
  add(value_N, low_N, high_N);
  const double over_jnd = JndLine{}.error_over_jnd(value_N, truth_N);
  ++known;
  if (over_jnd <= 1.0) ++within;
  worst_over_jnd = std::max(worst_over_jnd, over_jnd);
}

Path training_path(int variant) {
  return [variant](double time_s) {
    // Two tones whose sum does not repeat within a minute, compressed so that the
    // tool pauses at the turning points.
    const double pace = variant == 0 ? 1.0 : 0.93;
    const double slow = std::sin(2.0 * M_PI * 0.41 * pace * time_s + 0.4 * variant);
    const double fast = std::sin(2.0 * M_PI * 1.37 * pace * time_s);
    return 0.0025 + 0.0035 * std::tanh(1.4 * (0.75 * slow + 0.45 * fast));
  };
}

Path scaled(const Path& path, double factor, double offset_m) {
  return [=](double time_s) { return offset_m + factor * path(time_s); };
}

TrainingRequest clean_request() {
  TrainingRequest request;
  request.scene = "hard case";
  request.surface = Surface::recorded;
  request.features = {
      {FeatureKind::depth, 0.0, {}}, {FeatureKind::velocity, 0.0, {}}, {FeatureKind::lowpass_velocity, 0.17, {}}};
  return request;
}

std::vector<HardCase> fit_methods(const Recording& recording, const TrainingRequest& request) {
  MotionSource source({prepare_recording(recording)});
  const Result<PreparedTraining> prepared = prepare_training(source, request);
  std::vector<HardCase> cases;
  for (const Method* method : methods()) {
    HardCase& made = cases.emplace_back();
    made.method = method->name;
    MethodRequest what;
    what.method = method;
    const Result<MethodFit> fitted = prepared ? fit_method(*prepared, what) : Result<MethodFit>(prepared.error());
    if (fitted) {
      made.model = std::make_shared<const FittedModel>(fitted->data);
    } else {
      made.refusal = fitted.error().message;
    }
  }
  return cases;
}

void evaluate_press(const Press& press, std::vector<HardCase>& cases) {
  ForceModels models;
  std::vector<HardCase*> fitted;
  for (HardCase& one : cases) {
    if (one.model == nullptr) continue;
    models.push_back(one.model);
    fitted.push_back(&one);
  }
  std::size_t row = 0;
  (void)replay(press.recording, models, [&](const RecordingRow&, const TickSnapshot& snapshot, const HapticsTick&) {
    const double truth_N = press.true_N[row++];
    if (!snapshot.in_contact) return;
    for (std::size_t i = 0; i < fitted.size(); ++i)
      fitted[i]->add(snapshot.force_N[i], truth_N, 0.0, kForceMargin * fitted[i]->model->data().largest_force_N);
  });
}

void expect_safe(const std::string& name, const std::vector<HardCase>& cases) {
  for (const HardCase& one : cases) {
    std::printf("%-44s %-8s ", name.c_str(), one.method.c_str());
    if (!one.refusal.empty()) {
      std::printf("refused: %s\n", one.refusal.c_str());
    } else {
      std::printf("%zu values, %zu of %zu within the JND, worst error %.3g JND\n", one.count, one.within, one.known,
                  one.worst_over_jnd);
    }
    EXPECT_EQ(one.unsafe, 0U) << name << ", " << one.method << ": of " << one.count;
  }
}

}  // namespace palpate::test
