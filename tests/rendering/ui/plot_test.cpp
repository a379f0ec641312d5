#include "rendering/ui/plot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

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
  EXPECT_DOUBLE_EQ(round_up(1.01), 1.2);
  EXPECT_DOUBLE_EQ(round_up(12.1), 15.0);
  EXPECT_DOUBLE_EQ(round_up(6.3), 8.0);
  EXPECT_DOUBLE_EQ(round_up(0.081), 0.1);
  EXPECT_DOUBLE_EQ(round_up(-3.0), 1.0);
}

// Distance of a point from the nearest piece of a line.
float distance_to(const std::vector<ImVec2>& line, const ImVec2& point) {
  float least = 1e9F;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const ImVec2 along(line[i].x - line[i - 1].x, line[i].y - line[i - 1].y);
    const ImVec2 off(point.x - line[i - 1].x, point.y - line[i - 1].y);
    const float share =
        std::clamp((off.x * along.x + off.y * along.y) / (along.x * along.x + along.y * along.y), 0.0F, 1.0F);
    least = std::min(least, std::hypot(off.x - share * along.x, off.y - share * along.y));
  }
  return least;
}

TEST(Plot, ALineWithFewerPointsLooksTheSame) {
  std::vector<ImVec2> level, wave, peaks;
  for (int i = 0; i < 400; ++i) {
    const auto x = static_cast<float>(i);
    level.emplace_back(x, 5.0F);
    wave.emplace_back(x, 40.0F * std::sin(0.03F * x));
    peaks.emplace_back(x, i % 7 == 0 ? 30.0F : 0.0F);
  }
  for (const auto& [line, most] : {std::pair{level, 20u}, std::pair{wave, 60u}, std::pair{peaks, 240u}}) {
    const std::vector<ImVec2> kept = simplified(line);
    EXPECT_LE(kept.size(), most);
    EXPECT_EQ(kept.front().x, line.front().x);
    EXPECT_EQ(kept.back().x, line.back().x);
    for (const ImVec2& point : line) EXPECT_LE(distance_to(kept, point), 0.36F) << point.x;
  }
  EXPECT_TRUE(simplified({}).empty());
  EXPECT_EQ(simplified({{1.0F, 2.0F}}).size(), 1u);
}

}  // namespace
}  // namespace palpate
