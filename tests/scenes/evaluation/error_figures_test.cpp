#include "scenes/evaluation/model_errors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

constexpr double kRounding = 1e-12;  // a few roundings of doubles

TEST(ForceBins, AreTwoJndWideAtEveryForce) {
  for (const JndLine jnd : {JndLine{}, JndLine{0.5, 0.0}, JndLine{1e-3, 0.2}}) {
    for (const double force_N : {0.01, 0.3, 6.0, 30.0, 3000.0}) {
      const std::size_t bin = force_bin(force_N, jnd);
      if (bin + 1 == kMaximumForceBins) continue;  // contains all larger forces
      const double from_N = force_bin_begin_N(bin, jnd);
      const double to_N = force_bin_begin_N(bin + 1, jnd);
      EXPECT_LE(from_N, force_N * (1.0 + kRounding));
      EXPECT_GT(to_N, force_N * (1.0 - kRounding));
      // The integral of dF / JND over the bin, by the midpoint rule with 1000 steps.
      double jnds = 0.0;
      const double step_N = (to_N - from_N) / 1000.0;
      for (int i = 0; i < 1000; ++i) jnds += step_N / jnd.at(from_N + (i + 0.5) * step_N);
      EXPECT_NEAR(jnds, kBinWidth_jnd, 1e-4);
    }
  }
  EXPECT_EQ(force_bin(0.3, {}), 2u) << "the third of three";
  EXPECT_EQ(force_bin(6.0, {}), 15u);
  EXPECT_EQ(force_bin(3000.0, {}), 63u);
  EXPECT_EQ(force_bin(-0.02, {}), 0u) << "sensor noise";
}

// Errors of 1, 2 ... 1000 mN with a constant JND of 500 mN.
TEST(ErrorFigures, AddUp) {
  const JndLine jnd{0.5, 0.0};
  ErrorFigures figures;
  for (int i = 1; i <= 1000; ++i) figures.add(1.2 + 1e-3 * ((i % 2 != 0) ? i : -i), 1.2, i <= 10, jnd);
  EXPECT_EQ(figures.samples(), 1000u);
  EXPECT_NEAR(figures.within_jnd(), 0.5, 1e-3) << "an error of exactly one JND may round either way";
  const ErrorSummary summary = figures.summary(jnd);
  EXPECT_NEAR(summary.rms_error_N, std::sqrt(1001.0 * 2001.0 / 6.0) * 1e-3, 1e-9);
  EXPECT_NEAR(summary.max_error_N, 1.0, kRounding);
  EXPECT_NEAR(summary.max_error_over_jnd, 2.0, kRounding);
  EXPECT_NEAR(figures.mean_error_over_jnd(), 1.001, 1e-9);
  EXPECT_EQ(summary.out_of_domain_samples, 10u);
  const std::vector<ForceBin>& bins = summary.bins;  // 1 N each
  ASSERT_EQ(bins.size(), 2u);
  EXPECT_EQ(bins[0].force_N.count(), 0u);
  EXPECT_EQ(bins[1].force_N.count(), 1000u);
  EXPECT_NEAR(bins[1].force_N.mean(), 1.2, kRounding);
  EXPECT_NEAR(bins[1].error_N.mean(), 0.5005, 1e-9);
  EXPECT_NEAR(bins[1].error_N.deviation(), std::sqrt((1e6 - 1.0) / 12.0) * 1e-3, 1e-9);
  EXPECT_NEAR(bins[1].over_jnd.deviation(), 2.0 * bins[1].error_N.deviation(), 1e-9);
  EXPECT_NEAR(bins[1].jnd_N, 0.5, kRounding);
}

}  // namespace
}  // namespace palpate
