// The tick: faults for bad samples, and no repeated computation. live_tick_test.cpp tests that it does nothing
// forbidden.
#include "engine/tick/haptics_tick.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/tick/sensor_identification.h"
#include "tests/support/example_model.h"

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

}  // namespace
}  // namespace palpate
