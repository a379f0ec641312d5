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

}  // namespace
}  // namespace palpate
