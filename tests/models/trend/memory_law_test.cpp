#include "models/trend/trend_estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/exact_samples.h"
#include "tests/support/feature_specs.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

constexpr double kDepth_m = 5e-3;

// Strokes of various speeds, two seconds each, in and out of a spring with a Maxwell branch of these times.
Samples strokes_into(std::initializer_list<double> times_s, double slowing = 0.0) {
  FeatureSpec spec = test::spectrum(times_s, {kDepth_m, {2.0, 0.0, 0.0, 0.0}});
  spec.slowing = slowing;
  FeatureFilter branches({spec});
  return test::exact_samples(10000, kDepth_m, [&](std::size_t i) {
    const double time_s = 2e-3 * static_cast<double>(i);
    const int stroke = static_cast<int>(i) / 1000;
    const double rate_per_s = std::numbers::pi * (1.0 + stroke % 4);
    const double position_m = kDepth_m * (0.6 + 0.04 * stroke) * std::sin(rate_per_s * time_s);
    const double velocity_m_per_s = kDepth_m * (0.6 + 0.04 * stroke) * rate_per_s * std::cos(rate_per_s * time_s);
    const double branch_N = test::feed(branches, time_s, position_m, velocity_m_per_s).values[0];
    const double force_N = position_m > 0.0 ? std::max(0.0, 400.0 * position_m + branch_N) : 0.0;
    return test::ExactRow{time_s, position_m, velocity_m_per_s, force_N, stroke % 5};
  });
}

// Neighbouring candidates differ by a factor of 10^(1/4), so that one of them is within half of it.
TEST(IdentifyRelaxation, FindsTheTimeOfABranch) {
  for (const double time_s : {0.05, 0.3}) {
    const auto found_s = test::must(identify_relaxation(strokes_into({time_s}), {}, false, 1, {}));
    ASSERT_EQ(found_s.size(), 1u);
    EXPECT_LE(std::abs(std::log10(found_s[0] / time_s)), 1.0 / 8.0 + 1e-9) << time_s;
  }
}

TEST(IdentifyRelaxation, RefusesRecordingsWithoutCandidatesAndCanBeInterrupted) {
  Samples samples = strokes_into({0.1});
  const FitControl stop{[](double) { return false; }};
  EXPECT_EQ(test::message_of(identify_relaxation(samples, {}, true, 2, stop)), "interrupted");
  samples.longest_recording_s = 0.01;
  EXPECT_EQ(test::message_of(identify_relaxation(samples, {}, true, 1, {})),
            "the recordings are too short to identify a relaxation time; record for longer, or pass --features scene");
}

TEST(SelectSlowing, FindsHowTheRelaxationDependsOnDepth) {
  for (const double slowing : {1.5, -1.5}) {
    const Samples samples = strokes_into({0.1}, slowing);
    FeatureList list;
    list.add(FeatureKind::maxwell_spectrum, {0.02, 0.1, 0.5});
    std::vector<PartGain> gains;
    const FeatureList law = test::must(select_slowing(samples, {}, list, gains, {}));
    EXPECT_TRUE(gains.back().taken);
    EXPECT_LT(gains.back().error_with, gains.back().error_without);
    // The simplest that is not significantly worse: at least half of it.
    EXPECT_GE(law.features.back().slowing / slowing, 0.5);
    EXPECT_LE(law.features.back().slowing / slowing, 1.0);
  }
}

TEST(SelectSlowing, TakesNoneWhereThereIsNone) {
  const Samples samples = strokes_into({0.1});
  FeatureList list;
  list.add(FeatureKind::maxwell_spectrum, {0.02, 0.1, 0.5});
  std::vector<PartGain> gains;
  const FeatureList law = test::must(select_slowing(samples, {}, list, gains, {}));
  ASSERT_EQ(gains.size(), 1u);
  EXPECT_EQ(gains[0].name, "depth-dependent relaxation");
  EXPECT_FALSE(gains[0].taken);
  EXPECT_EQ(law.features, list.features);
  const FitControl stop{[](double) { return false; }};
  EXPECT_EQ(test::message_of(select_slowing(samples, {}, list, gains, stop)), "interrupted");
}

}  // namespace
}  // namespace palpate
