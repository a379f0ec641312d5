#include "scenes/live/verdict.h"

#include <gtest/gtest.h>

#include "tests/support/message_parts.h"

namespace palpate {
namespace {

JudgedModel model(std::size_t slot, const char* name, bool paper, double over_jnd, double ns) {
  return {{over_jnd > 1.0 ? 0.98 - 0.1 * over_jnd : 0.995, over_jnd, ns},
          slot,
          name,
          paper,
          {ns, 0.99 * ns, 1.01 * ns, ns}};
}

// The sentence of the issue: ours against the most accurate one of the paper.
TEST(Verdict, ComparesTheRecommendedModelWithTheBestOfTheOtherKind) {
  const Verdict verdict = judge(
      {model(0, "voxel", true, 2.5, 200.0), model(1, "greedy", true, 1.8, 240.0), model(2, "trend", false, 0.4, 390.0)},
      "");
  EXPECT_EQ(verdict.chosen, 2u);
  EXPECT_EQ(verdict.headline,
            "Use trend: 99.5 % of the test is within one JND, a tick takes 0.39 us. greedy: 80.0 %, 1.6 times faster.");
  EXPECT_EQ(verdict.detail, "");
}

TEST(Verdict, OfEquallyGoodModelsTheFasterOneComesFirst) {
  const Verdict verdict = judge({model(4, "greedy", true, 0.49, 240.0), model(7, "trend", false, 0.4, 390.0)}, "");
  EXPECT_EQ(verdict.chosen, 4u);
  EXPECT_EQ(verdict.headline,
            "Use greedy: 99.5 % of the test is within one JND, a tick takes 0.24 us. trend: 99.5 %, 1.6 times slower.");
  EXPECT_EQ(verdict.detail, " trend has a lower 99 % error, by too little to count, and is slower.");
}

TEST(Verdict, WhereNoneIsGoodEnoughBothErrorsAreNamed) {
  const Verdict verdict = judge({model(0, "greedy", true, 3.1, 390.0), model(1, "trend", false, 1.4, 395.0)}, "");
  EXPECT_EQ(verdict.headline,
            "No model is good enough; the rule takes trend: 84.0 % of the test is within one JND, a tick takes 0.4 us. "
            "greedy: 67.0 %, as fast.");
}

TEST(Verdict, WithoutATrueForceTheReferenceIsNamed) {
  const Verdict verdict = judge({model(1, "mine", true, 0.4, 300.0)}, "voxel");
  EXPECT_TRUE(test::has_parts(verdict.headline, {"mine differs from voxel by 0.40 JND"}));
  EXPECT_EQ(verdict.headline.find("test"), std::string::npos);
}

// Two starts of the program measure times that differ by what other programs add; the sentence stays the same.
TEST(Verdict, TimesThatDifferByATenthOrByOtherProgramsAreEqual) {
  const auto words = [](const Timing& one, const Timing& other) { return time_words(one, other); };
  EXPECT_EQ(words({300.0, 290.0, 320.0, 0.0}, {325.0, 322.0, 330.0, 0.0}), "as fast");
  EXPECT_EQ(words({300.0, 290.0, 320.0, 0.0}, {400.0, 292.0, 900.0, 0.0}), "as fast");
  EXPECT_EQ(words({300.0, 290.0, 900.0, 0.0}, {400.0, 390.0, 410.0, 0.0}), "1.3 times faster");
  EXPECT_EQ(tick_share(391.0), "0.04 %");
}

}  // namespace
}  // namespace palpate
