#include "rendering/ui/plot.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

TEST(Plot, TicksAreRoundAndNotTooMany) {
  EXPECT_DOUBLE_EQ(tick_step(10.0, 5), 2.0);
  EXPECT_DOUBLE_EQ(tick_step(10.0, 4), 5.0);
  EXPECT_DOUBLE_EQ(tick_step(0.7, 7), 0.1);
  EXPECT_DOUBLE_EQ(tick_step(3.0, 10), 0.5);
  for (const double span : {1e-3, 0.3, 7.0, 12345.0}) {
    for (int most = 1; most < 12; ++most) EXPECT_LE(span / tick_step(span, most), most * (1.0 + 1e-9));
  }
  EXPECT_EQ(tick_step(0.0, 4), 1.0) << "nothing to divide";
  EXPECT_EQ(tick_step(std::nan(""), 4), 1.0);
}

}  // namespace
}  // namespace palpate
