#include "models/samples/sample.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

std::vector<Sample> kept_of(GrowingStride rows, int count, double period_s) {
  for (int i = 0; i < count; ++i) {
    Sample row;
    row.tool.time_s = i * period_s;
    rows.add(row);
  }
  return rows.rows();
}

TEST(GrowingStride, KeepsEveryRowThatItHasRoomFor) { EXPECT_EQ(kept_of(GrowingStride(100), 99, 1e-3).size(), 99u); }

TEST(GrowingStride, GoesOverTheWholeInLongerSteps) {
  const auto kept = kept_of(GrowingStride(100), 1000, 1e-3);
  EXPECT_GE(kept.size(), 50u);
  EXPECT_LT(kept.size(), 100u);
  EXPECT_GT(kept.back().tool.time_s, 0.9);
}

TEST(GrowingStride, IsThatOfTheBeginningWhenRowsMayNotBeFurtherApart) {
  const auto at_1_kHz = kept_of(GrowingStride(100, 1.5e-3), 1000, 1e-3);
  EXPECT_EQ(at_1_kHz.size(), 100u);
  EXPECT_DOUBLE_EQ(at_1_kHz.back().tool.time_s, 0.099);
  const auto at_4_kHz = kept_of(GrowingStride(100, 1.5e-3), 4000, 0.25e-3);
  EXPECT_NEAR(at_4_kHz[1].tool.time_s - at_4_kHz[0].tool.time_s, 1e-3, 1e-12);
  EXPECT_NEAR(at_4_kHz.back().tool.time_s, 0.099, 2e-3);
}

}  // namespace
}  // namespace palpate
