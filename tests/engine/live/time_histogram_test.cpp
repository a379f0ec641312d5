// Percentiles from a histogram, without storing the times.
#include "engine/live/pacer.h"

#include <gtest/gtest.h>

#include <limits>

namespace palpate {
namespace {

TEST(TimeHistogram, GivesPercentilesWithinABin) {
  TimeHistogram histogram;
  for (std::int64_t time_us = 1; time_us <= 10000; ++time_us) histogram.add(1000 * time_us);
  const TimePercentiles result = histogram.percentiles();
  EXPECT_EQ(result.count, 10000u);
  // Bins are a 32nd of an octave, 3.2 % wide; a percentile is the upper edge of its bin.
  EXPECT_NEAR(result.p50_us, 5000.0, 0.032 * 5000.0);
  EXPECT_NEAR(result.p99_us, 9900.0, 0.032 * 9900.0);
  EXPECT_NEAR(result.p99_9_us, 9990.0, 0.032 * 9990.0);
  EXPECT_GE(result.p99_us, 9900.0) << "never flattering";
  EXPECT_EQ(result.max_us, 10000.0);
}

TEST(TimeHistogram, TakesEveryTimeThereIs) {
  TimeHistogram histogram;
  EXPECT_EQ(histogram.percentiles().count, 0u);
  EXPECT_EQ(histogram.percentiles().max_us, 0.0);
  for (int bit = 0; bit < 63; ++bit) {
    histogram.add(std::int64_t{1} << bit);
    histogram.add((std::int64_t{1} << bit) - 1);
  }
  histogram.add(std::numeric_limits<std::int64_t>::max());
  histogram.add(-5);
  EXPECT_EQ(histogram.percentiles().count, 128u);
  EXPECT_EQ(histogram.percentiles().max_us, 1e-3 * 9223372036854775807.0);
}

}  // namespace
}  // namespace palpate
