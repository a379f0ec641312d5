#include "engine/tick/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/tick/haptics_tick.h"
#include "models/model/fitted_model.h"
#include "tests/support/example_model.h"
#include "tests/support/feature_specs.h"

namespace palpate {
namespace {

// Features against closed forms. Motion estimates are given exactly, so that only the filters are tested.

using namespace test;

// The relative rounding error of sums over some thousand steps is well below this.
constexpr double kRounding = 1e-11;

TEST(Features, FreeAirForgetsStopsAndCreepGoesOnInIt) {
  FeatureFilter filter({stops({1e-4}, stiffening()), creep({0.5}, stiffening())});
  feed(filter, 0.0, 0.0);
  EXPECT_GT(feed(filter, 0.1, 5e-3).values[1], 0.0);
  feed(filter, 0.2, -1e-3);
  EXPECT_EQ(feed(filter, 0.3, -1e-3).values[0], 0.0);
  const FeatureFilter left = filter;
  EXPECT_LT(feed(filter, 0.4, 5e-5).values[1], stiffening().at(5e-5) * 5e-5 / 5e-3) << "bent backwards by the way out";
  filter = left;
  for (int i = 1; i <= 20000; ++i) feed(filter, 0.3 + 10.0 * i, -1e-3);
  // After t = 4e5 tau, q = r / sqrt(2 t / tau) is a thousandth of r.
  EXPECT_NEAR(feed(filter, 200001.0, 5e-5).values[1], stiffening().at(5e-5) * 5e-5 / 5e-3,
              2e-3 * stiffening().at(5e-5));
  EXPECT_NEAR(filter.vector().values[0], stiffening().at(5e-5) * 0.5, 1e-15) << "bristles arrive unbent";
}

// The work of a closed cycle after the transient, by the trapezoidal rule.
double work_of_a_cycle(const FeatureSpec& spec, double duration_s, int steps) {
  FeatureFilter filter({spec});
  double before_N = 0.0;
  double work = 0.0;
  for (int cycle = 0; cycle < 4; ++cycle) {
    work = 0.0;
    for (int i = 0; i < steps; ++i) {
      const double phase = static_cast<double>(i) / steps;
      const double next = static_cast<double>(i + 1) / steps;
      const double force_N = feed(filter, duration_s * (cycle + next), closed_motion_m(next)).values[0];
      work += 0.5 * (force_N + before_N) * (closed_motion_m(next) - closed_motion_m(phase));
      before_N = force_N;
    }
  }
  return work;
}

TEST(Features, AClosedCycleNeverGivesBackMoreThanItTook) {
  const DriveCurve saturating{8e-3, {4.0, -6.0, 4.0, -1.0}};
  for (const double duration_s : {0.05, 0.5, 5.0}) {
    EXPECT_GT(work_of_a_cycle(stops({5e-5, 2e-4, 8e-4}, stiffening()), duration_s, 20000), 0.0);
    EXPECT_GT(work_of_a_cycle(stops({1e-4}, saturating), duration_s, 20000), 0.0);
    EXPECT_GT(work_of_a_cycle(spectrum({0.01, 0.1, 1.0}, stiffening()), duration_s, 20000), 0.0);
  }
}

// The discretisation is exact for linear motion between samples. Here the depth
// deviates from linear by at most a h^2 / 8 = 0.1 um at 500 Hz, and the filters forget
// it. The tolerance of 0.1 % of each feature's range has a margin of ten.
void expect_same_at_every_rate(const std::vector<FeatureSpec>& specs) {
  // The values at 500 Hz of a motion that is sampled at `rate_Hz`.
  const auto run = [&](double rate_Hz) {
    std::vector<std::array<double, kMaxFeatures>> at_500_Hz;
    FeatureFilter filter(specs);
    const int every = static_cast<int>(rate_Hz / 500.0);
    for (int i = 0; i <= static_cast<int>(4.0 * rate_Hz); ++i) {
      const double t = static_cast<double>(i) / rate_Hz;
      const double omega = 2.0 * std::numbers::pi * 1.1;
      // Strokes in and out of the block, with tremor.
      const double tremor = 2.0 * std::numbers::pi * 9.0;
      const double position_m = 3e-3 * std::sin(omega * t) + 5e-5 * std::sin(tremor * t);
      const double velocity_m_per_s = 3e-3 * omega * std::cos(omega * t) + 5e-5 * tremor * std::cos(tremor * t);
      const FeatureVector& vector = feed(filter, t, position_m, velocity_m_per_s);
      if (i % every == 0) at_500_Hz.push_back(vector.values);
    }
    return at_500_Hz;
  };
  const auto fast = run(2000.0);
  for (const auto& [rate_Hz, tolerance] : {std::pair{500.0, 2e-3}, {1000.0, 1e-3}}) {
    const auto slow = run(rate_Hz);
    ASSERT_EQ(slow.size(), fast.size());
    for (std::size_t k = 0; k < specs.size(); ++k) {
      double range = 0.0, error = 0.0;
      for (std::size_t i = 0; i < fast.size(); ++i) {
        range = std::max(range, std::abs(fast[i][k]));
        error = std::max(error, std::abs(slow[i][k] - fast[i][k]));
      }
      EXPECT_LE(error, tolerance * range) << feature_name(specs[k]) << " at " << rate_Hz << " Hz";
    }
  }
}

TEST(Features, TheSameMotionGivesTheSameFeaturesAtEveryRate) {
  const std::vector<FeatureSpec> specs = {FeatureSpec{},
                                          {FeatureKind::velocity, 0.0, {}},
                                          lowpass(0.17),
                                          lowpass(1.27),
                                          spectrum({0.1}, stiffening()),
                                          spectrum({0.02, 0.2, 2.0}, stiffening()),
                                          stops({1e-4, 4e-4}, stiffening()),
                                          creep({2.0}, stiffening())};
  expect_same_at_every_rate(specs);
  FeatureSpec slowing = spectrum({0.1}, stiffening());
  slowing.slowing = 2.0;
  expect_same_at_every_rate({FeatureSpec{}, slowing});
}

TEST(Features, FreeAirRelaxesAndDoesNotLoad) {
  FeatureFilter filter({FeatureSpec{},
                        {FeatureKind::velocity, 0.0, {}},
                        lowpass(0.17),
                        spectrum({0.1}, stiffening()),
                        spectrum({0.1}, stiffening()),
                        stops({1e-4}, stiffening()),
                        creep({0.5}, stiffening())});
  int i = 0;
  // Fast strokes in the air do not change any feature.
  for (; i < 500; ++i) {
    const FeatureVector& vector = feed(filter, 1e-3 * i, -0.02 + 0.019 * std::sin(0.1 * i), 1.9 * std::cos(0.1 * i));
    ASSERT_EQ(vector.values, FeatureVector{}.values);
    ASSERT_FALSE(vector.in_contact);
  }
  feed(filter, 1e-3 * i++, -1e-6);
  // In by 3 mm, then out within 1 ms. After that the memory only decays.
  for (int k = 0; k < 100; ++k) feed(filter, 1e-3 * i++, 3e-5 * k, 0.03);
  feed(filter, 1e-3 * i++, -1e-3, -4.0);
  const double start = filter.vector().values[2];
  const double branch = filter.vector().values[3];
  EXPECT_LT(start, 0.0) << "pulled out faster than it relaxes";
  for (int k = 1; k < 1000; ++k) {
    const FeatureVector& vector = feed(filter, 1e-3 * i++, -1e-3 - 1e-4 * std::abs(std::sin(k)), 0.1);
    ASSERT_EQ(vector.values[0], 0.0);
    ASSERT_EQ(vector.values[1], 0.0);
    ASSERT_NEAR(vector.values[2], start * std::exp(-1e-3 * k / 0.17), std::abs(start) * kRounding);
    ASSERT_NEAR(vector.values[3], branch * std::exp(-1e-3 * k / 0.1), std::abs(branch) * kRounding);
    ASSERT_EQ(vector.values[4], vector.values[3]);
    ASSERT_EQ(vector.values[5], 0.0);
    ASSERT_LT(vector.values[6], 3e-3 * std::exp(-1e-3 * (k - 1) / 0.5));
  }
}

TEST(Features, ContactIsThatOfTheRawPosition) {
  FeatureFilter filter({FeatureSpec{}});
  const FeatureVector touching = filter.update({0.0, 1e-6, 0.0, 0.0}, {-1e-6, 0.0});
  EXPECT_TRUE(touching.in_contact);
  EXPECT_EQ(touching.values[0], 0.0);
  const FeatureVector free = filter.update({1e-3, 0.0, 0.0, 0.0}, {2e-6, 0.0});
  EXPECT_FALSE(free.in_contact);
  EXPECT_EQ(free.values[0], 2e-6);
}

TEST(Features, HaveNamesWithUnits) {
  EXPECT_EQ(feature_name({}), "feature_depth_m");
  EXPECT_EQ(feature_name({FeatureKind::velocity, 0.0, {}}), "feature_velocity_m_per_s");
  EXPECT_EQ(feature_name(lowpass(0.17)), "feature_lowpass_velocity_0.17s_m_per_s");
  EXPECT_EQ(feature_name(lowpass(1.0 / 3.0)), "feature_lowpass_velocity_0.3333s_m_per_s");
  EXPECT_EQ(feature_name(spectrum({1.27}, stiffening())), "feature_maxwell_spectrum_1.27s_N");
  EXPECT_EQ(feature_name(spectrum({0.02, 0.3}, stiffening())), "feature_maxwell_spectrum_0.02-0.3s_N");
  EXPECT_EQ(feature_name(stops({1e-4}, stiffening())), "feature_stops_0.1mm_N");
  EXPECT_EQ(feature_name(creep({0.1, 6.0}, stiffening())), "feature_creep_0.1-6s_N");
}

// After an hour at rest in contact, filters are exactly zero and never were denormal.
TEST(Features, AnHourAtRestLeavesZero) {
  FeatureFilter filter({lowpass(0.17), spectrum({1.27}, stiffening())});
  feed(filter, 0.0, 0.0);
  FeatureVector vector;
  for (int i = 1; i <= 3600000; ++i) {
    vector = feed(filter, 1e-3 * i, 4e-3);
    for (std::size_t k = 0; k < 2; ++k)
      if (std::fpclassify(vector.values[k]) == FP_SUBNORMAL) FAIL() << i;
  }
  EXPECT_EQ(vector.values[0], 0.0);
  EXPECT_EQ(vector.values[1], 0.0);
}

// Compares parts computed four at a time with the equations of features.h.

double by_lane(double x, std::size_t lane) {
  V4 lanes{-1.0, -2.0, 3.0, 0.5};
  lanes[lane] = x;
  to_exponential(lanes);
  return lanes[lane];
}

// The reference, std::exp, is itself accurate to 1 ulp.
TEST(Exponential, IsGoodToAnUlp) {
  const double ulp = std::numeric_limits<double>::epsilon();
  for (double x = -690.0; x < 690.0; x += 0.0371) ASSERT_NEAR(by_lane(x, 1) / std::exp(x), 1.0, 2 * ulp) << x;
  for (double x = 1e-9; x < 1.0; x *= 1.01) ASSERT_NEAR(by_lane(-x, 2) / std::exp(-x), 1.0, 2 * ulp) << x;
}

DriveCurve drive_of(std::size_t i) {
  const double size = static_cast<double>(i + 1);
  return {4e-3 + 5e-4 * size, {0.3 * size, 0.1, 0.02 * size, 0.05}};
}
double time_of(std::size_t i) { return 1e-3 * std::pow(2.5, static_cast<double>(i)); }

// A motion in and out, beyond the reference depth of some drives.
double depth_at(int i) { return std::max(0.0, 9e-3 * std::sin(0.01 * i)); }

class FeatureLanes : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Parts, FeatureLanes, testing::Values(1, 2, 3, 4, 5, 13, 64),
                         [](const auto& instance) { return std::to_string(instance.param); });

TEST_P(FeatureLanes, BranchesFollowTheirEquation) {
  BranchLanes lanes;
  std::vector<double> z(GetParam(), 0.0);
  for (std::size_t i = 0; i < z.size(); ++i) lanes.add(drive_of(i), time_of(i % 13));
  PartMemory memory{};
  lanes.advance(0.0, depth_at(0), 0.0, memory);
  for (int t = 1; t < 1000; ++t) {
    const double step_s = 1e-3 * (1.0 + 0.5 * std::sin(1.0 * t));
    lanes.advance(depth_at(t - 1), depth_at(t), step_s, memory);
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double keep = by_lane(-step_s / time_of(i % 13), 0);
      const double gain = time_of(i % 13) * (1.0 - keep) / step_s;
      z[i] = keep * z[i] + gain * (drive_of(i).at(depth_at(t)) - drive_of(i).at(depth_at(t - 1)));
      // A thousand steps of two exponentials, each accurate to an ulp.
      ASSERT_NEAR(sum_of_lanes(memory.value, i, 1), z[i], 1e-12) << i << " at " << t;
    }
  }
}

// Stops in the even lanes, creeping bristles in the odd ones.
TEST_P(FeatureLanes, BristlesFollowTheirEquations) {
  constexpr double kStep_s = 1e-3;
  BristleLanes lanes;
  PartMemory memory{};
  V4 force_N[kMaxLaneGroups];
  std::vector<double> bend(GetParam(), 0.0);
  const auto creeps = [](std::size_t i) { return i % 2 == 1; };
  const auto threshold = [&](std::size_t i) { return creeps(i) ? 5e-3 : 1e-4 * static_cast<double>(i + 1); };
  const auto time = [](std::size_t i) { return 1e-3 * std::pow(10.0, static_cast<double>(i % 5)); };
  for (std::size_t i = 0; i < bend.size(); ++i) lanes.add(drive_of(i), threshold(i), creeps(i) ? time(i) : 0.0);
  for (int t = 1; t < 1000; ++t) {
    lanes.advance(depth_at(t - 1), depth_at(t), kStep_s, memory.value, force_N);
    for (std::size_t i = 0; i < bend.size(); ++i) {
      if (creeps(i)) {
        const auto half = [&](double q) { return q / std::sqrt(1.0 + kStep_s / time(i) * (q / 5e-3) * (q / 5e-3)); };
        bend[i] = half(half(bend[i]) + depth_at(t) - depth_at(t - 1));
      } else {
        // Out of contact a stop relaxes to zero.
        const double limit_m = depth_at(t) > 0.0 ? threshold(i) : 0.0;
        bend[i] = std::clamp(bend[i] + depth_at(t) - depth_at(t - 1), -limit_m, limit_m);
      }
      // Products of creep are in another order: a difference of some ulps a step, which creep forgets.
      ASSERT_NEAR(sum_of_lanes(force_N, i, 1), drive_of(i).at(depth_at(t)) * bend[i] / threshold(i),
                  creeps(i) ? 1e-12 : 1e-15)
          << i << " at " << t;
    }
  }
}

// The memory of features: relaxation times that depend on depth, and the memory kept in an exchange of models
// (engine/tick/features.h).

// A complete material. Energy returned in a cycle may have been stored in an earlier one, so the sum over all cycles
// from rest must be positive.
TEST(FeatureMemory, TimesThatSlowMakeNoEnergy) {
  const DriveCurve elastic{5e-3, {0.5, 0.4}};
  for (const double slowing : {0.0, 3.0, -2.0}) {
    for (const double duration_s : {0.05, 0.5, 5.0}) {
      FeatureSpec branches = spectrum({0.01, 0.1, 1.0}, stiffening());
      branches.slowing = slowing;
      FeatureFilter filter({branches});
      double before_N = 0.0;
      double work = 0.0;
      constexpr int kSteps = 20000;
      feed(filter, 0.0, closed_motion_m(0.0));
      for (int i = 1; i <= 4 * kSteps; ++i) {
        const double phase = static_cast<double>(i) / kSteps;
        const double position_m = closed_motion_m(phase);
        const double force_N = elastic.at(position_m) + feed(filter, duration_s * phase, position_m).values[0];
        work += 0.5 * (force_N + before_N) * (position_m - closed_motion_m(phase - 1.0 / kSteps));
        before_N = force_N;
      }
      EXPECT_GT(work, 0.0) << slowing << " " << duration_s;
    }
  }
}

// After an exchange of models in mid-press, the memory of equal features continues.
TEST(FeatureMemory, AnotherFilterAdoptsTheMemoryOfTheSameFeatures) {
  const DriveCurve softer{5e-3, {0.2, 0.1, 0.0, 0.0}};
  const std::vector<FeatureSpec> specs = {spectrum({0.3}, stiffening()), stops({3e-4, 1e-4}, stiffening()),
                                          creep({2.0}, stiffening()), spectrum({0.3}, softer)};
  FeatureFilter before({FeatureSpec{}, stops({5e-4}, softer), specs[1], specs[2], specs[0]});
  FeatureFilter always(specs);
  const auto at = [](int i) { return closed_motion_m(2e-4 * i); };
  for (int i = 0; i < 2000; ++i) {
    feed(before, 1e-3 * i, at(i));
    feed(always, 1e-3 * i, at(i));
  }
  FeatureFilter after(specs);
  feed(after, 1.999, at(1999));
  after.adopt(before);
  EXPECT_EQ(after.vector().values[3], 0.0) << "a branch of no earlier model is at rest";
  for (int i = 2000; i < 4000; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(after.vector().values[k], always.vector().values[k]) << feature_name(specs[k]);
    }
    feed(after, 1e-3 * i, at(i));
    feed(always, 1e-3 * i, at(i));
  }
  EXPECT_NEAR(after.vector().values[3], always.vector().values[3], 0.01 * std::abs(always.vector().values[0]))
      << "after seven times its relaxation time";
}

// An excursion beyond the training domain is remembered as one to its edge, by every feature; the depth itself is not
// changed.
TEST(FeatureMemory, KeepsNoDepthBeyondTheDomain) {
  constexpr double kDeepest_m = 4e-3;
  FeatureSpec slowed = spectrum({0.05, 0.8}, stiffening());
  slowed.slowing = 1.5;
  const std::vector<FeatureSpec> specs = {FeatureSpec{}, lowpass(0.17), slowed, stops({0.1e-3, 1e-3}, stiffening()),
                                          creep({2.0}, stiffening())};
  for (const double beyond_m : {4.1e-3, 8e-3, 0.5, 1e3}) {
    FeatureFilter far(specs, kDeepest_m), edge(specs, kDeepest_m), free(specs);
    bool differs = false;
    for (int i = 0; i < 1000; ++i) {
      const double position_m = 3e-3 * std::sin(0.02 * i);
      const bool out = i > 200 && i % 97 < 5;
      feed(far, 1e-3 * i, out ? beyond_m : position_m);
      feed(edge, 1e-3 * i, out ? kDeepest_m : position_m);
      feed(free, 1e-3 * i, out ? beyond_m : position_m);
      ASSERT_EQ(far.vector().values[0], out ? beyond_m : std::max(0.0, position_m));
      for (std::size_t k = 1; k < specs.size(); ++k) ASSERT_EQ(far.vector().values[k], edge.vector().values[k]) << k;
      differs = differs || free.vector().values != far.vector().values;
    }
    EXPECT_TRUE(differs);
  }
}

// How a stream begins: at rest, as the end of a training recording, or after a given motion.

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
