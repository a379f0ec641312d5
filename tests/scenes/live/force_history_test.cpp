#include "scenes/live/comparison.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

HistoryPoint point_at(double loop_time_s) {
  HistoryPoint point;
  point.loop_time_s = loop_time_s;
  return point;
}

TEST(ForceHistory, KeepsTheLastMinuteInOrder) {
  ForceHistory history;
  EXPECT_EQ(history.size(), 0u);
  EXPECT_EQ(history.first_at(0.0), 0u);
  const auto most = static_cast<std::size_t>(kHistory_s * 1000.0);
  for (std::size_t i = 0; i < most + 2500; ++i) history.append(point_at(1e-3 * static_cast<double>(i)));
  ASSERT_EQ(history.size(), most);
  EXPECT_EQ(history[0].loop_time_s, 2.5);
  for (std::size_t i = 1; i < most; ++i) ASSERT_GT(history[i].loop_time_s, history[i - 1].loop_time_s);
}

TEST(ForceHistory, FindsATime) {
  ForceHistory history;
  const auto most = static_cast<std::size_t>(kHistory_s * 1000.0);
  for (std::size_t i = 0; i < most + 777; ++i) history.append(point_at(static_cast<double>(i)));
  EXPECT_EQ(history.first_at(-1.0), 0u);
  EXPECT_EQ(history.first_at(777.0), 0u);
  EXPECT_EQ(history.first_at(777.5), 1u);
  EXPECT_EQ(history[history.first_at(5000.0)].loop_time_s, 5000.0);
  EXPECT_EQ(history.first_at(1e9), history.size());
}

}  // namespace
}  // namespace palpate
