// Against closed forms; models/evaluation's figures come from here as well.
#include "engine/tick/error_figures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

constexpr double kRounding = 1e-12;  // a few roundings of doubles

TEST(ErrorFigures, NothingGivesZeros) {
  const ErrorFigures figures;
  EXPECT_EQ(figures.samples(), 0u);
  EXPECT_EQ(figures.within_jnd(), 0.0);
  EXPECT_EQ(figures.rms_error_N(), 0.0);
  EXPECT_EQ(figures.mean_error_over_jnd(), 0.0);
  EXPECT_TRUE(figures.bins({}).empty());
}

TEST(ErrorFigures, AddUp) {
  const JndLine jnd{0.5, 0.0};
  ErrorFigures figures;
  for (int i = 1; i <= 1000; ++i) figures.add(1.2 + 1e-3 * i, 1.2, i <= 10, jnd);
  EXPECT_EQ(figures.samples(), 1000u);
  EXPECT_NEAR(figures.within_jnd(), 0.5, 1e-3) << "an error of exactly one JND may round either way";
  EXPECT_NEAR(figures.rms_error_N(), std::sqrt(1001.0 * 2001.0 / 6.0) * 1e-3, 1e-9);
  EXPECT_NEAR(figures.max_error_N(), 1.0, kRounding);
  EXPECT_NEAR(figures.max_error_over_jnd(), 2.0, kRounding);
  EXPECT_NEAR(figures.mean_error_over_jnd(), 1.001, 1e-9);
  EXPECT_EQ(figures.out_of_domain_samples(), 10u);
  const std::vector<ForceBin> bins = figures.bins(jnd);
  ASSERT_EQ(bins.size(), 3u);
  EXPECT_EQ(bins[0].count, 0u);
  EXPECT_EQ(bins[2].count, 1000u);
  EXPECT_NEAR(bins[2].mean_abs_error_N, 0.5005, 1e-9);
  EXPECT_NEAR(bins[2].std_abs_error_N, std::sqrt((1e6 - 1.0) / 12.0) * 1e-3, 1e-9);
}

TEST(ErrorFigures, HaveNoMoreBinsThanTheMost) {
  ErrorFigures figures;
  figures.add(0.0, 1e9, false, {});
  EXPECT_EQ(figures.bins({}).size(), kMaximumForceBins);
}

}  // namespace
}  // namespace palpate
