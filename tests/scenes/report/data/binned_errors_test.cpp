#include "scenes/report/data/binned_errors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

TEST(BinnedErrors, AreFinerAtSmallForces) {
  BinnedErrors errors(JndLine{}, 16.0);
  for (double force_N = 0.001; force_N < 16.0; force_N += 0.01) errors.add(force_N, force_N);
  const std::vector<ErrorBin> bins = errors.bins();
  ASSERT_EQ(bins.size(), kForceBins);
  EXPECT_EQ(bins.front().force_from_N, 0.0);
  EXPECT_EQ(bins.back().force_to_N, 16.0);
  EXPECT_NEAR(bins.front().force_to_N, 0.1, 0.001) << "a tenth of an even bin";
  for (std::size_t i = 1; i < bins.size(); ++i) {
    EXPECT_EQ(bins[i].force_from_N, bins[i - 1].force_to_N);
    EXPECT_GT(bins[i].force_to_N - bins[i].force_from_N, bins[i - 1].force_to_N - bins[i - 1].force_from_N);
  }
}

TEST(BinnedErrors, TakeTheErrorOverTheJndSampleBySample) {
  const JndLine jnd;
  BinnedErrors errors(jnd, 100.0);
  // Two samples in the first bin, whose forces have different thresholds.
  errors.add(0.1, 0.0);
  errors.add(0.7, 0.5);
  errors.add(0.1, -0.1);  // noise below zero counts in the first bin
  const std::vector<ErrorBin> bins = errors.bins();
  ASSERT_EQ(bins.size(), 1u) << "empty bins stay out";
  EXPECT_EQ(bins[0].count, 3u);
  const double ratios[] = {0.1 / jnd.at(0.0), 0.2 / jnd.at(0.5), 0.2 / jnd.at(0.1)};
  EXPECT_NEAR(bins[0].max_error_over_jnd, ratios[2], 1e-12);
  EXPECT_NEAR(bins[0].mean_error_over_jnd, (ratios[0] + ratios[1] + ratios[2]) / 3.0, 1e-12);
  EXPECT_NEAR(bins[0].mean_abs_error_N, 0.5 / 3.0, 1e-12);
  EXPECT_NEAR(bins[0].std_abs_error_N, std::sqrt(0.02 / 9.0), 1e-12);
  EXPECT_NEAR(bins[0].max_abs_error_N, 0.2, 1e-12);
}

}  // namespace
}  // namespace palpate
