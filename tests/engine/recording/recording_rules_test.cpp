#include "engine/recording/recording.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

// The final verdict of the rules on `count` rows, `step_s` apart, with a gap of a minute after the fourth.
std::optional<RowFault> verdict(int count, double step_s) {
  RowRules rules;
  for (int i = 0; i < count; ++i) {
    if (auto fault = rules.check({i * step_s + (i > 3 ? 60.0 : 0.0), 0.0, 0.0, 0.0, 0.0})) return fault;
  }
  return rules.finish();
}

TEST(RowRules, AllowFivePercentBeyondTheRangeOfRates) {
  for (const int count : {10, 999, 1000, 1001}) {
    EXPECT_FALSE(verdict(count, 0.104).has_value()) << count;
    EXPECT_TRUE(verdict(count, 0.106).has_value()) << count;
    EXPECT_FALSE(verdict(count, 48e-6).has_value()) << count;
    EXPECT_TRUE(verdict(count, 47e-6).has_value()) << count;
  }
}

TEST(RowRules, NameTheColumnAtFault) {
  const auto role = [](const RecordingRow& row) {
    RowRules rules;
    const auto fault = rules.check(row);
    return fault ? fault->role : ColumnRole::kIgnored;
  };
  EXPECT_EQ(role({0, 0, 0, 0, 0}), ColumnRole::kIgnored);
  EXPECT_EQ(role({0, 1.0, -1e6, 0, 0}), ColumnRole::kIgnored);
  EXPECT_EQ(role({HUGE_VAL, 0, 0, 0, 0}), ColumnRole::kTime);
  EXPECT_EQ(role({0, -1.01, 0, 0, 0}), ColumnRole::kPosition);
  EXPECT_EQ(role({0, 0, 1.01e6, 0, 0}), ColumnRole::kForce);
  EXPECT_EQ(role({0, 0, 0, NAN, 0}), ColumnRole::kVelocity);
  EXPECT_EQ(role({0, 0, 0, 0, -HUGE_VAL}), ColumnRole::kAcceleration);
}

}  // namespace
}  // namespace palpate
