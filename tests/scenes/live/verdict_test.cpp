#include "scenes/live/verdict.h"

#include <gtest/gtest.h>

#include "tests/support/message_parts.h"

namespace palpate {
namespace {

JudgedModel model(std::size_t slot, const char* name, bool paper, double over_jnd, double ns) {
  return {slot, name, paper, over_jnd > 1.0 ? 0.98 - 0.1 * over_jnd : 0.995, over_jnd, {ns, 0.99 * ns, 1.01 * ns, ns}};
}

// The sentence of the issue: ours against the most accurate one of the paper.
TEST(Verdict, ComparesTheRecommendedModelWithTheBestOfTheOtherKind) {
  const Verdict verdict = judge(
      {model(0, "voxel", true, 2.5, 200.0), model(1, "greedy", true, 1.8, 240.0), model(2, "trend", false, 0.4, 390.0)},
      "");
  EXPECT_EQ(verdict.chosen, 2u);
  EXPECT_FALSE(verdict.noticeable);
  EXPECT_EQ(verdict.headline,
            "trend feels like the block. greedy differs by 1.8 of what a hand can notice, in 0.62 of the time (240 "
            "against 390 ns).");
}

TEST(Verdict, WhereNoneIsGoodEnoughBothErrorsAreNamed) {
  const Verdict verdict = judge({model(0, "greedy", true, 3.1, 390.0), model(1, "trend", false, 1.4, 395.0)}, "");
  EXPECT_TRUE(verdict.noticeable);
  EXPECT_EQ(verdict.headline,
            "trend differs by 1.4 of what a hand can notice. greedy differs by 3.1 of what a hand can notice, as fast "
            "(390 ns).");
}

// Two starts of the program measure times that differ by what other programs add; the sentence stays the same.
TEST(Verdict, TimesThatDifferByATenthOrByOtherProgramsAreEqual) {
  const auto words = [](const Timing& one, const Timing& other) { return time_words(one, other); };
  EXPECT_EQ(words({300.0, 290.0, 320.0, 0.0}, {325.0, 322.0, 330.0, 0.0}), "as fast (300 ns)");
  EXPECT_EQ(words({300.0, 290.0, 320.0, 0.0}, {400.0, 292.0, 900.0, 0.0}), "as fast (300 ns)");
  EXPECT_EQ(words({300.0, 290.0, 900.0, 0.0}, {400.0, 390.0, 410.0, 0.0}), "in 0.75 of the time (300 against 400 ns)");
  EXPECT_EQ(tick_share(391.0), "0.04 %");
}

}  // namespace
}  // namespace palpate
