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

TEST(Plot, ScalesEndAtRoundNumbers) {
  EXPECT_DOUBLE_EQ(round_up(1.0), 1.0);
  EXPECT_DOUBLE_EQ(round_up(1.01), 1.5);
  EXPECT_DOUBLE_EQ(round_up(6.3), 8.0);
  EXPECT_DOUBLE_EQ(round_up(0.081), 0.1);
  EXPECT_DOUBLE_EQ(round_up(-3.0), 1.0);
}

TEST(Plot, LabelsKeepTheirOrderAndStandApart) {
  const std::vector<float> places = spread_labels({50.0F, 51.0F, 49.0F, 99.0F}, 10.0F, 0.0F, 100.0F);
  EXPECT_LE(places[2] + 10.0F, places[0]);
  EXPECT_LE(places[0] + 10.0F, places[1]);
  EXPECT_FLOAT_EQ(places[3], 99.0F) << "nothing is in its way";
  // All at the lower edge: they go up as far as they must.
  const std::vector<float> low = spread_labels({100.0F, 100.0F, 100.0F}, 10.0F, 0.0F, 100.0F);
  EXPECT_FLOAT_EQ(low[0], 80.0F);
  EXPECT_FLOAT_EQ(low[2], 100.0F);
  EXPECT_TRUE(spread_labels({}, 10.0F, 0.0F, 100.0F).empty());
}

}  // namespace
}  // namespace palpate
