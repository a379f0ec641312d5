// The tick: faults for bad samples, and no repeated computation. live_tick_test.cpp tests that it does nothing
// forbidden.
#include "engine/tick/haptics_tick.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/tick/motion_estimator.h"
#include "tests/support/example_model.h"
#include "tests/support/live_doubles.h"

namespace palpate {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::shared_ptr<const FittedModel> fitted(const ModelData& data) { return std::make_shared<const FittedModel>(data); }

// Returns the force and the domain that a test sets.
class StubModel final : public test::NamedModel {
 public:
  explicit StubModel(double force_N, bool outside = false) : NamedModel("stub"), force_N_(force_N), outside_(outside) {}
  double force(const double*) const noexcept override { return force_N_; }
  void assess(const double*, ForceEstimate& estimate) const noexcept override { estimate.out_of_domain = outside_; }

 private:
  double force_N_;
  bool outside_;
};

TEST(HapticsTick, LatchesBadSamplesAndKeepsItsState) {
  HapticsTick tick({}, {fitted(test::example_models().front())});
  for (int i = 1; i <= 100; ++i) tick.step({1e-3 * i, 3e-3, 0.0, 0.0});
  const TickSnapshot before = tick.step({0.101, 3e-3, 0.0, 0.0});
  ASSERT_GT(before.force_N[0], 0.0);
  const auto expect_kept = [&](const ToolSample& sample, TickFault fault) {
    const TickSnapshot after = tick.step(sample);
    EXPECT_EQ(after.fault, fault);
    EXPECT_EQ(after.time_s, before.time_s);
    EXPECT_EQ(after.position_m, before.position_m);
    EXPECT_EQ(after.force_N, before.force_N);
  };
  expect_kept({0.102, kNaN, 0.0, 0.0}, TickFault::bad_sample);
  expect_kept({0.102, kInfinity, 0.0, 0.0}, TickFault::bad_sample);
  expect_kept({kNaN, 3e-3, 0.0, 0.0}, TickFault::bad_sample);
  expect_kept({0.102, 3e-3, kNaN, 0.0}, TickFault::bad_sample);
  expect_kept({0.102, 3e-3, 0.0, -kInfinity}, TickFault::bad_sample);
  expect_kept({0.101, 4e-3, 0.0, 0.0}, TickFault::time_not_later);
  expect_kept({0.05, 4e-3, 0.0, 0.0}, TickFault::time_not_later);
  // The next good sample continues as if the bad one had not existed.
  const TickSnapshot after = tick.step({0.102, 3e-3, 0.0, 0.0});
  EXPECT_EQ(after.fault, TickFault::none);
  EXPECT_EQ(after.tick, 109u) << "bad samples are ticks as well";
  HapticsTick undisturbed({}, {fitted(test::example_models().front())});
  for (int i = 1; i <= 101; ++i) undisturbed.step({1e-3 * i, 3e-3, 0.0, 0.0});
  EXPECT_EQ(after.force_N, undisturbed.step({0.102, 3e-3, 0.0, 0.0}).force_N);
}

TEST(HapticsTick, ABadFirstSampleStartsNothing) {
  HapticsTick tick({}, {fitted(test::example_models().front())});
  EXPECT_EQ(tick.step({0.0, kNaN, 0.0, 0.0}).fault, TickFault::bad_sample);
  EXPECT_EQ(tick.step({-5.0, 3e-3, 0.0, 0.0}).fault, TickFault::none);
}

TEST(HapticsTick, ANonFiniteForceIsZeroAndAFault) {
  for (const double force_N : {kNaN, kInfinity, -kInfinity}) {
    HapticsTick tick({}, {std::make_shared<StubModel>(force_N), std::make_shared<StubModel>(1.5, true)});
    tick.step({0.0, 1e-3, 0.0, 0.0});
    const TickSnapshot snapshot = tick.assess();
    EXPECT_EQ(snapshot.fault, TickFault::force_not_finite);
    EXPECT_EQ(snapshot.force_N[0], 0.0);
    EXPECT_EQ(snapshot.force_N[1], 1.5);
    EXPECT_EQ(snapshot.out_of_domain_mask, 2u);
  }
}

TEST(HapticsTick, GivesNoForceOutOfContact) {
  ForceModels models = test::example_force_models();
  models.push_back(std::make_shared<StubModel>(7.0, true));
  HapticsTick tick({30e-6, 0.0}, models);
  int outside = 0;
  const std::vector<RecordingRow> rows = test::example_recording(5000, 1000.0, 30e-6).rows;
  // Where no row reaches the surface, the force is not that of free air.
  EXPECT_LT(least_contact_N(rows.data(), rows.size(), 1.0), 0.1);
  for (const RecordingRow& row : rows) {
    const TickSnapshot& snapshot = tick.step(tool_sample(row));
    EXPECT_EQ(snapshot.in_contact, row.position_m > 0.0);
    EXPECT_EQ(snapshot.depth_m, std::max(0.0, row.position_m));
    if (snapshot.in_contact) continue;
    ++outside;
    for (std::size_t m = 0; m < models.size(); ++m) ASSERT_EQ(snapshot.force_N[m], 0.0);
    ASSERT_EQ(snapshot.out_of_domain_mask, 0u);
  }
  EXPECT_GT(outside, 500);
}

TEST(HapticsTick, AModelWithoutABoundHasNoneInContact) {
  ModelData data = test::example_model("trend", KernelKind::cubic, test::maxwell_features(), 3);
  data.error_bound.reset();
  for (const std::size_t first : {std::size_t{0}, std::size_t{1900}}) {  // the second begins in mid-press
    HapticsTick tick({}, {fitted(data)});
    const Recording recording = test::example_recording(4000, 1000.0);
    for (std::size_t i = first; i < recording.rows.size(); ++i) {
      tick.step(tool_sample(recording.rows[i]));
      const TickSnapshot& found = tick.assess();
      ASSERT_EQ(std::isnan(found.predicted_error_N[0]), found.in_contact) << i;
    }
  }
}

// The bound of a stream that begins in mid-press covers what its past may have been, until the tool leaves the
// material.
TEST(HapticsTick, AStreamThatBeginsInContactHasAWiderBound) {
  constexpr std::size_t kStart = 1900;
  constexpr double kFloor_N = 0.01;
  for (const auto& features : {test::maxwell_features(), test::memory_features()}) {
    ModelData data = test::example_model("trend", KernelKind::cubic, features, 3);
    data.error_bound = ErrorBound{kFloor_N, 0.0, 0.0};
    HapticsTick whole({}, {fitted(data)});
    HapticsTick cut({}, {fitted(data)});
    const Recording recording = test::example_recording(6000, 1000.0);
    double widest_N = 0.0;
    bool left = false;
    for (std::size_t i = 0; i < recording.rows.size(); ++i) {
      const ToolSample sample = tool_sample(recording.rows[i]);
      whole.step(sample);
      if (i < kStart) continue;
      cut.step(sample);
      const TickSnapshot &expected = whole.assess(), &found = cut.assess();
      ASSERT_TRUE(i > kStart || found.in_contact);
      left = left || !found.in_contact;
      if (!found.in_contact) continue;
      EXPECT_EQ(expected.predicted_error_N[0], kFloor_N);
      if (left) {
        EXPECT_EQ(found.predicted_error_N[0], kFloor_N) << i;
      } else {
        EXPECT_LE(std::abs(found.force_N[0] - expected.force_N[0]), found.predicted_error_N[0]) << i;
        widest_N = std::max(widest_N, found.predicted_error_N[0]);
      }
    }
    EXPECT_TRUE(left);
    EXPECT_GT(widest_N, 0.1);
  }
}

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
  const ForceModels models{fitted(data)};
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
      after.recall(history);
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
