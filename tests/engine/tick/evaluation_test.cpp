// Error statistics against closed forms.
#include "engine/tick/evaluation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

// One rounding of a float for the stored ratios, a few of doubles elsewhere.
constexpr double kRounding = 1e-12;
constexpr double kFloatRounding = 1e-7;

TEST(Evaluation, NoSampleGivesDefinedZeros) {
  const ErrorSummary summary = ErrorStatistics(JndLine{}).summary();
  EXPECT_EQ(summary.samples, 0u);
  EXPECT_EQ(summary.rms_error_N, 0.0);
  EXPECT_EQ(summary.within_jnd, 0.0);
  EXPECT_EQ(summary.p99_error_over_jnd, 0.0);
  EXPECT_TRUE(summary.bins.empty());
}

TEST(Evaluation, OneSample) {
  ErrorStatistics statistics(JndLine{0.1, 0.1});
  statistics.add(1.3, 1.0, true);
  const ErrorSummary summary = statistics.summary();
  EXPECT_EQ(summary.samples, 1u);
  EXPECT_NEAR(summary.rms_error_N, 0.3, kRounding);
  EXPECT_NEAR(summary.max_error_N, 0.3, kRounding);
  EXPECT_EQ(summary.within_jnd, 0.0);
  EXPECT_NEAR(summary.max_error_over_jnd, 1.5, kRounding);
  EXPECT_NEAR(summary.p99_error_over_jnd, 1.5, 1.5 * kFloatRounding);
  EXPECT_EQ(summary.out_of_domain_samples, 1u);
  ASSERT_EQ(summary.bins.size(), 3u);
  EXPECT_EQ(summary.bins[2].count, 1u);
  EXPECT_EQ(summary.bins[2].std_abs_error_N, 0.0);
}

// Errors 1, 2 ... 1000 mN at a JND of 500 mN throughout.
TEST(Evaluation, UniformErrorsHaveTheirClosedForms) {
  ErrorStatistics statistics(JndLine{0.5, 0.0});
  const int n = 1000;
  for (int i = 1; i <= n; ++i) statistics.add(0.2 + 1e-3 * ((i % 2 != 0) ? i : -i), 0.2, false);
  const ErrorSummary summary = statistics.summary();
  // Sum of squares n(n+1)(2n+1)/6.
  EXPECT_NEAR(summary.rms_error_N, 1e-3 * std::sqrt((n + 1.0) * (2.0 * n + 1.0) / 6.0), kRounding);
  EXPECT_NEAR(summary.max_error_N, 1.0, kRounding);
  EXPECT_NEAR(summary.within_jnd, 0.5, 1.5e-3) << "the one at the limit may round either way";
  EXPECT_NEAR(summary.p99_error_over_jnd, 0.990 / 0.5, 2.0 * kFloatRounding);
  EXPECT_NEAR(summary.max_error_over_jnd, 2.0, kRounding);
  ASSERT_EQ(summary.bins.size(), 1u);
  EXPECT_NEAR(summary.bins[0].mean_abs_error_N, 1e-3 * (n + 1.0) / 2.0, kRounding);
  EXPECT_NEAR(summary.bins[0].std_abs_error_N, 1e-3 * std::sqrt((n * static_cast<double>(n) - 1.0) / 12.0), kRounding);
  EXPECT_NEAR(summary.bins[0].max_abs_error_N, 1.0, kRounding);
}

TEST(Evaluation, TheJndIsThatOfTheMeasuredForce) {
  ErrorStatistics statistics(JndLine{});
  statistics.add(2.0 + 0.065 + 0.0633 * 2.0 - 1e-9, 2.0, false);
  statistics.add(2.0 + 0.065 + 0.0633 * 2.0 + 1e-9, 2.0, false);
  EXPECT_EQ(statistics.summary().within_jnd, 0.5);
}

TEST(Evaluation, PercentileIsTheNearestRank) {
  for (const int n : {1, 2, 99, 100, 101, 200, 1000}) {
    ErrorStatistics statistics(JndLine{1.0, 0.0});
    for (int i = n; i >= 1; --i) statistics.add(i, 0.0, false);
    const double expected = std::ceil(0.99 * n - 1e-9);
    EXPECT_NEAR(statistics.summary().p99_error_over_jnd, expected, expected * kFloatRounding) << n;
  }
}

TEST(Evaluation, BinsCoverTheForcesFromZeroToTheLargest) {
  ErrorStatistics statistics(JndLine{0.065, 0.0633});
  for (const double measured_N : {-0.01, 0.0, 0.499, 0.5, 1.7}) statistics.add(measured_N + 0.1, measured_N, false);
  const ErrorSummary summary = statistics.summary();
  ASSERT_EQ(summary.bins.size(), 4u);
  const std::uint64_t counts[] = {3, 1, 0, 1};
  for (std::size_t i = 0; i < 4; ++i) {
    const ForceBin& bin = summary.bins[i];
    EXPECT_EQ(bin.force_from_N, 0.5 * static_cast<double>(i));
    EXPECT_EQ(bin.force_to_N, 0.5 * static_cast<double>(i + 1));
    EXPECT_EQ(bin.count, counts[i]);
    EXPECT_NEAR(bin.jnd_N, 0.065 + 0.0633 * (0.25 + 0.5 * static_cast<double>(i)), kRounding);
    EXPECT_NEAR(bin.mean_abs_error_N, counts[i] > 0 ? 0.1 : 0.0, kRounding);
  }
}

TEST(Evaluation, AnAbsurdForceDoesNotMakeAMillionBins) {
  ErrorStatistics statistics(JndLine{});
  statistics.add(1.0, 1e6, false);
  EXPECT_EQ(statistics.summary().bins.size(), kMaximumForceBins);
}

}  // namespace
}  // namespace palpate
