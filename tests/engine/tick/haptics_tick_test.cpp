// The tick: no forbidden operations, faults for bad samples, and no repeated
// computation.
#include "engine/tick/haptics_tick.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/tick/sensor_identification.h"
#include "tests/support/example_model.h"
#include "tests/support/rt_guard.h"

namespace palpate {
namespace {

using Models = std::vector<std::shared_ptr<const ForceModel>>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::shared_ptr<const FittedModel> fitted(const ModelData& data) { return std::make_shared<const FittedModel>(data); }

// Returns the estimate that a test sets.
class StubModel final : public ForceModel {
 public:
  explicit StubModel(double force_N, bool outside = false) : force_N_(force_N), outside_(outside) {}
  ForceEstimate evaluate(const double*) const noexcept override { return {force_N_, outside_}; }
  const std::vector<FeatureSpec>& features() const noexcept override { return features_; }
  const std::string& name() const noexcept override { return name_; }
  const std::string& method() const noexcept override { return name_; }
  int centre_count() const noexcept override { return 0; }

 private:
  std::vector<FeatureSpec> features_ = test::position_features();
  std::string name_ = "stub";
  double force_N_;
  bool outside_;
};

// 10,000 ticks over strokes that enter, leave and exceed the models' domain, with
// bad samples among them. Returns the sum of all offences.
int offences(const Models& models, const SensorSpec& sensor) {
  Recording recording = test::example_recording(10000, 1000.0, sensor.encoder_step_m);
  recording.rows[500].position_m = kNaN;
  recording.rows[600].time_s = 0.0;
  for (std::size_t i = 5000; i < 5100; ++i) recording.rows[i].position_m *= 3.0;
  HapticsTick tick(sensor, models);
  double sum = 0.0;
  test::RtGuard guard;
  for (const RecordingRow& row : recording.rows) {
    tick.rehearse();
    sum += tick.step(tool_sample(row)).force_N[0];
  }
  const int total = guard.stop().total();
  EXPECT_GT(sum, 0.0) << "the tool was never in contact";
  return total;
}

TEST(HapticsTick, DoesNothingForbiddenInTenThousandTicksOfEveryModel) {
  if (!test::rt_guard_works()) GTEST_SKIP() << "a sanitizer owns malloc";
  Models all;
  for (const ModelData& data : test::example_models()) {
    all.push_back(fitted(data));
    EXPECT_EQ(offences({all.back()}, {30e-6, 0.0}), 0) << data.name;
  }
  EXPECT_EQ(offences(all, {30e-6, 0.0}), 0) << "all at once";
  EXPECT_EQ(offences(all, {0.0, 1e-6, true, 1e-3, true, 0.08}), 0) << "every sensor";
}

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
    const TickSnapshot snapshot = tick.step({0.0, 1e-3, 0.0, 0.0});
    EXPECT_EQ(snapshot.fault, TickFault::force_not_finite);
    EXPECT_EQ(snapshot.force_N[0], 0.0);
    EXPECT_EQ(snapshot.force_N[1], 1.5);
    EXPECT_EQ(snapshot.out_of_domain_mask, 2u);
  }
}

TEST(HapticsTick, GivesNoForceOutOfContact) {
  Models models;
  for (const ModelData& data : test::example_models()) models.push_back(fitted(data));
  models.push_back(std::make_shared<StubModel>(7.0, true));
  HapticsTick tick({30e-6, 0.0}, models);
  int outside = 0;
  for (const RecordingRow& row : test::example_recording(5000, 1000.0, 30e-6).rows) {
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

TEST(HapticsTick, ModelsOfTheSameFeaturesShareAFilter) {
  Models models;
  for (const ModelData& data : test::example_models()) models.push_back(fitted(data));
  const HapticsTick tick({}, models);
  EXPECT_EQ(tick.model_count(), 11u);
  EXPECT_EQ(tick.filter_count(), 5u) << "paper's four, Maxwell's four, position alone, memories, a lag";
  EXPECT_EQ(&tick.features_of(0), &tick.features_of(1));
  EXPECT_EQ(&tick.features_of(0), &tick.features_of(8));
  EXPECT_NE(&tick.features_of(0), &tick.features_of(3));
}

TEST(HapticsTick, OneModelsForceDoesNotDependOnItsNeighbours) {
  Models all;
  for (const ModelData& data : test::example_models()) all.push_back(fitted(data));
  HapticsTick together({30e-6, 0.0}, all);
  std::vector<HapticsTick> alone;
  for (const auto& model : all) alone.emplace_back(SensorSpec{30e-6, 0.0}, Models{model});
  for (const RecordingRow& row : test::example_recording(2000, 1000.0, 30e-6).rows) {
    const TickSnapshot snapshot = together.step(tool_sample(row));
    for (std::size_t m = 0; m < all.size(); ++m) {
      ASSERT_EQ(snapshot.force_N[m], alone[m].step(tool_sample(row)).force_N[0]);
    }
  }
}

// After an exchange in mid-press, common features are as if the second model had run from the start.
TEST(HapticsTick, AnotherModelGoesOnWithTheMemoriesOfTheFirst) {
  const ModelData first = test::example_model("greedy", KernelKind::cubic, test::memory_features(), 1);
  ModelData second = test::example_model("random", KernelKind::linear, test::memory_features(), 2);
  std::swap(second.features[2], second.features[4]);  // in another order
  ModelData third = test::example_model("trend", KernelKind::cubic, test::maxwell_features(), 3);
  const Recording recording = test::example_recording(1500, 1000.0, 30e-6);
  const SensorSpec sensor{30e-6, 0.0};
  HapticsTick always(sensor, {fitted(second)});
  HapticsTick before(sensor, {fitted(first)});
  const std::size_t change = 700;
  ASSERT_GT(recording.rows[change].position_m, 2e-3) << "in mid-press";
  for (std::size_t i = 0; i <= change; ++i) {
    before.step(tool_sample(recording.rows[i]));
    always.step(tool_sample(recording.rows[i]));
  }
  HapticsTick after(sensor, {fitted(second), fitted(third)});
  after.continue_from(before);
  EXPECT_EQ(after.snapshot().force_N[0], always.snapshot().force_N[0]);
  EXPECT_GT(after.snapshot().force_N[1], 0.0) << "of depth and velocity at once, its branches at rest";
  for (std::size_t i = change + 1; i < recording.rows.size(); ++i) {
    const double expected_N = always.step(tool_sample(recording.rows[i])).force_N[0];
    ASSERT_EQ(after.step(tool_sample(recording.rows[i])).force_N[0], expected_N) << i;
  }
}

TEST(HapticsTick, ResetStartsANewStream) {
  const Recording recording = test::example_recording(500, 1000.0, 30e-6);
  HapticsTick tick({30e-6, 0.0}, {fitted(test::example_models().front())});
  std::vector<double> first;
  for (const RecordingRow& row : recording.rows) first.push_back(tick.step(tool_sample(row)).force_N[0]);
  tick.reset();  // time may restart at an earlier value
  for (std::size_t i = 0; i < recording.rows.size(); ++i) {
    const TickSnapshot& snapshot = tick.step(tool_sample(recording.rows[i]));
    ASSERT_EQ(snapshot.fault, TickFault::none);
    ASSERT_EQ(snapshot.force_N[0], first[i]) << i;
  }
}

}  // namespace
}  // namespace palpate
