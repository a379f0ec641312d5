// How a stream begins: at rest, as the end of a training recording, or after a given motion.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/tick/replay.h"
#include "models/model/fitted_model.h"
#include "tests/support/example_model.h"
#include "tests/support/feature_specs.h"

namespace palpate {
namespace {

using namespace test;

std::vector<FeatureSpec> every_memory() {
  FeatureSpec slowed = spectrum({0.05, 0.8, 3.0}, stiffening());
  slowed.slowing = 1.5;
  return {FeatureSpec{}, {FeatureKind::velocity},           lowpass(0.17),
          slowed,        stops({1e-4, 1e-3}, stiffening()), creep({2.0}, stiffening())};
}

TEST(Beginning, InContactAndNearerToAnEndThanToEveryBeginning) {
  const std::vector<double> memory(memory_size({FeatureSpec{}, lowpass(0.17)}), 0.5);
  const FeaturePlan plan({FeatureSpec{}, lowpass(0.17)}, 1.0, {{-2e-3, 3e-3, memory}, {1e-3, 5e-3, memory}});
  const struct {
    double first_m;
    int began;
  } cases[] = {{-2e-3, kBeganAtRest}, {0.0, kBeganAtRest}, {1.5e-3, kBeganAtRest},
               {2e-3, kBeganAtRest},  {2.1e-3, 0},         {3.9e-3, 0},
               {4.1e-3, 1},           {50e-3, 1}};
  for (const auto& [first_m, began] : cases) {
    FeatureState state;
    plan.begin(state, {7.0, first_m});
    EXPECT_EQ(state.began, began) << first_m;
    plan.update(state, {7.0, first_m}, {first_m});
    EXPECT_EQ(state.vector.values[1], began < 0 ? 0.0 : 0.5) << first_m;
  }
}

// From the end on, such a stream has the same bits as one that went on.
TEST(Beginning, AtTheEndOfARecordingContinuesIt) {
  const std::vector<FeatureSpec> specs = every_memory();
  FeatureFilter always(specs);
  const auto at = [](int i) { return closed_motion_m(3e-4 * i); };
  for (int i = 0; i < 2000; ++i) feed(always, 1e-3 * i, at(i));
  const std::vector<double> memory = always.plan().memory_of(always.state());
  ASSERT_EQ(memory.size(), memory_size(specs));
  FeatureFilter continued(specs, 1.0, {{-1e-3, at(1999), memory}}), rested(specs);
  continued.begin({1.999, at(1999)});
  for (int i = 1999; i < 4000; ++i) {
    feed(continued, 1e-3 * i, at(i));
    feed(rested, 1e-3 * i, at(i));
    if (i > 1999) feed(always, 1e-3 * i, at(i));
    for (std::size_t k = 2; k < specs.size(); ++k)
      ASSERT_EQ(continued.vector().values[k], always.vector().values[k]) << i << " " << feature_name(specs[k]);
  }
  EXPECT_NE(rested.vector().values[3], always.vector().values[3]);
}

Recording press_and_hold(double from_s, double to_s) {
  Recording recording;
  for (int i = static_cast<int>(1e3 * from_s); i < static_cast<int>(1e3 * to_s); ++i)
    recording.rows.push_back({1e-3 * i, std::min(4e-3, 2e-3 * std::max(0.0, 1e-3 * i - 0.5)), 0.1});
  return recording;
}

std::vector<double> forces_of(const Recording& recording, const ForceModels& models, const Recording* after,
                              double& bound_N) {
  std::vector<double> forces_N;
  bound_N = 0.0;
  replay(
      recording, models,
      [&](const RecordingRow&, const TickSnapshot& snapshot, const HapticsTick&) {
        forces_N.push_back(snapshot.force_N[0]);
        bound_N = std::max(bound_N, snapshot.predicted_error_N[0]);
      },
      0.0, after);
  return forces_N;
}

TEST(Beginning, AfterARecordingHasTheForcesOfOneRecording) {
  ModelData data = example_model("trend", KernelKind::cubic, memory_features(), 5);
  data.correction = nullptr;
  data.error_bound = ErrorBound{0.01, 0.02, 0.3};
  const ForceModels models{std::make_shared<const FittedModel>(data)};
  double known_N, told_N, unknown_N;
  const Recording first = press_and_hold(0.0, 3.0), second = press_and_hold(3.0, 5.0);
  const std::vector<double> whole_N = forces_of(press_and_hold(0.0, 5.0), models, nullptr, known_N);
  const std::vector<double> continued_N = forces_of(second, models, &first, told_N);
  const std::vector<double> rested_N = forces_of(second, models, nullptr, unknown_N);
  // The tool is at rest, so that the motion estimate of both is that of the readings.
  for (std::size_t i = 0; i < continued_N.size(); ++i) ASSERT_NEAR(continued_N[i], whole_N[3000 + i], 1e-6) << i;
  EXPECT_GT(std::abs(rested_N[0] - whole_N[3000]), 0.05);
  EXPECT_GT(unknown_N, told_N + 0.05) << "the memory is known after a recording";
  data.provenance.recordings = {"press"};
  EXPECT_EQ(began_words(data, 0), "as the end of press");
  EXPECT_EQ(began_words(data, kBeganAtRest), "at rest");
  EXPECT_EQ(began_words(data, kBeganAsTold), "as the end of the recording before");
}

}  // namespace
}  // namespace palpate
