#include "scenes/report/measure/coverage_finder.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(Thinned, IsEvenlySpread) {
  std::vector<CoveragePoint> points(1000);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].force_N = static_cast<double>(i);
  const auto some = thinned(points, 10);
  ASSERT_EQ(some.size(), 10u);
  EXPECT_EQ(some[3].force_N, 300.0);
  EXPECT_EQ(thinned(points, 2000).size(), 1000u);
}

}  // namespace
}  // namespace palpate
