// Features against closed forms. Motion estimates are given exactly, so that only the filters are tested.
#include "engine/tick/features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "tests/support/feature_specs.h"

namespace palpate {
namespace {

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

}  // namespace
}  // namespace palpate
