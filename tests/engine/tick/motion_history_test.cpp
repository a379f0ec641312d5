// The state of models that join in mid-press (engine/tick/motion_history.h).
#include "engine/tick/motion_history.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models/model/fitted_model.h"
#include "tests/support/example_model.h"

namespace palpate {
namespace {

using Models = std::vector<std::shared_ptr<const ForceModel>>;

constexpr std::size_t kJoin = 1900;   // in mid-press
constexpr std::size_t kNotSeen = 40;  // ticks before kJoin that the slow side has not read yet

struct Join {
  bool knows_history = true;
  std::size_t restart = 0;  // the stream restarts at this tick
};

// The largest force difference over half a second between a model that joins at kJoin and
// one that ran from the start.
double difference_N(const ModelData& data, const Join& join) {
  const Recording recording = test::example_recording(kJoin + 500, 1000.0);
  EXPECT_GT(recording.rows[kJoin].position_m, 2e-3) << "in mid-press";
  const Models models{std::make_shared<const FittedModel>(data)};
  HapticsTick always({}, models);
  HapticsTick before({}, {});
  HapticsTick after({}, models);
  MotionHistory history;
  double largest_N = 0.0;
  for (std::size_t i = 0; i < recording.rows.size(); ++i) {
    const ToolSample sample{recording.rows[i].time_s, recording.rows[i].position_m, 0.0, 0.0};
    if (i == join.restart) {
      always.reset();
      before.reset();
    }
    const double expected_N = always.step(sample).force_N[0];
    if (i < kJoin) {
      const TickSnapshot& snapshot = before.step(sample);
      if (join.knows_history && i + kNotSeen < kJoin) history.add(snapshot, i == join.restart);
      continue;
    }
    if (i == kJoin) {
      history.recall(after);
      after.continue_from(before);
    }
    largest_N = std::max(largest_N, std::abs(after.step(sample).force_N[0] - expected_N));
  }
  return largest_N;
}

ModelData slow_material() { return test::example_model("trend", KernelKind::cubic, test::maxwell_features(), 3); }

TEST(MotionHistory, AModelThatJoinsInMidPressKnowsThePressUpToNow) {
  // The last 40 ms of the motion are taken as linear, with branches of 0.1 and 1.1 s: 0.4 mN.
  EXPECT_LT(difference_N(slow_material(), {}), 1e-3);
  EXPECT_GT(difference_N(slow_material(), {.knows_history = false}), 0.1) << "at rest under the tool";
}

TEST(MotionHistory, OfEveryFeature) {
  for (const auto& features : {test::memory_features(), test::paper_features()}) {
    const ModelData data = test::example_model("trend", KernelKind::cubic, features, 4);
    EXPECT_LT(difference_N(data, {}), 0.5 * difference_N(data, {.knows_history = false}) + 1e-9);
  }
}

// Like the tick, the history forgets the previous stream.
TEST(MotionHistory, ForgetsWithANewStream) {
  EXPECT_LT(difference_N(slow_material(), {.restart = kJoin - 300}), 5e-3);
  // Nothing of the new stream was read yet: the material is at rest at its first sample.
  EXPECT_LT(difference_N(slow_material(), {.restart = kJoin}), 1e-12);
}

}  // namespace
}  // namespace palpate
