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

}  // namespace
}  // namespace palpate
