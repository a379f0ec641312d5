#include "scenes/report/figures/label_placer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace palpate {
namespace {

TEST(LabelPlacer, StandsRightOfItsPointWhereThereIsRoom) {
  LabelPlacer placer(400.0, 300.0);
  placer.keep_point_free(100.0, 100.0);
  const auto place = placer.beside(100.0, 100.0, "greedy");
  EXPECT_GT(place.x, 100.0);
  EXPECT_DOUBLE_EQ(place.y, 100.0);
  EXPECT_FALSE(place.far);
}

TEST(LabelPlacer, LabelsOfPointsInOnePlaceDoNotOverlap) {
  LabelPlacer placer(400.0, 300.0);
  std::vector<LabelPlacer::Place> places;
  placer.keep_point_free(200.0, 150.0);
  for (int i = 0; i < 6; ++i) places.push_back(placer.beside(200.0, 150.0, "random"));
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_TRUE(std::abs(places[i].x - places[j].x) > 40.0 || std::abs(places[i].y - places[j].y) >= 17.0) << i << j;
    }
  }
}

TEST(LabelPlacer, NeverLeavesThePlot) {
  LabelPlacer placer(400.0, 300.0);
  const auto place = placer.beside(395.0, 295.0, "direct");
  EXPECT_LT(place.x + 6 * 8.0, 400.0);
  EXPECT_LT(place.y, 300.0);
}

TEST(LabelPlacer, ALevelsNameLeavesItsPointsFree) {
  LabelPlacer placer(400.0, 300.0);
  placer.keep_point_free(380.0, 112.0);
  const auto place = placer.along(100.0, "1 JND");
  EXPECT_TRUE(place.x + 5 * 8.0 < 380.0 || place.y < 100.0);
}

}  // namespace
}  // namespace palpate
