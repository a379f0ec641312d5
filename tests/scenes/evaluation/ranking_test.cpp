// The rule of the best model.
#include <gtest/gtest.h>

#include "scenes/evaluation/model_errors.h"

namespace palpate {
namespace {

struct RankCase {
  const char* what;
  std::vector<Candidate> candidates;
  std::size_t best, recommended;
};

TEST(Rank, IsTheRuleOfTwoSentences) {
  const RankCase cases[] = {
      {"the largest share", {{0.74, 2.0, 100.0}, {0.95, 2.0, 300.0}}, 1, 1},
      {"also with a lower 99 % error of another", {{0.91, 1.4, 100.0}, {0.95, 1.9, 300.0}}, 1, 1},
      {"less than half a point: the shortest tick", {{0.946, 2.0, 100.0}, {0.95, 2.0, 300.0}}, 1, 0},
      {"one alone has 99 %: its share decides", {{0.97, 1.2, 100.0}, {0.992, 0.9, 300.0}}, 1, 1},
      {"two have 99 %: the lowest 99 % error", {{0.999, 0.6, 100.0}, {0.995, 0.4, 300.0}}, 1, 1},
      {"less than 0.1 JND: the shortest tick", {{0.999, 0.49, 100.0}, {0.995, 0.4, 300.0}}, 1, 0},
      {"just below 99 % with a larger 99 % error",
       {{0.989, 1.1, 90.0}, {0.992, 0.9, 200.0}, {0.995, 0.4, 300.0}},
       2,
       2},
      {"a tick above the budget", {{0.99, 1.0, 60e3}, {0.91, 1.5, 300.0}}, 1, 1},
      {"all ticks above the budget", {{0.99, 1.0, 60e3}, {0.91, 1.5, 70e3}}, 0, 0},
  };
  for (const RankCase& one : cases) {
    const Ranking ranking = rank(one.candidates);
    EXPECT_EQ(ranking.best, one.best) << one.what;
    EXPECT_EQ(ranking.recommended, one.recommended) << one.what;
    EXPECT_TRUE(ranking.as_good[ranking.recommended]) << one.what;
  }
  EXPECT_EQ(rank({{0.99, 1.0, 60e3}, {0.91, 1.5, 300.0}}, 100e3).recommended, 0u) << "another budget";
  EXPECT_EQ(rank({{0.995, 0.9, 100.0}, {0.999, 0.4, 300.0}}).fastest_below_jnd, 0u);
  EXPECT_EQ(rank({{0.9, 1.9, 100.0}}).fastest_below_jnd, std::nullopt);
}

// Both models have the same share. In one pair each stroke differs by the same; in the other a single stroke decides.
TEST(Rank, ADifferenceThatTheBootstrapDoesNotTellFromZeroDoesNotCount) {
  for (const bool every : {true, false}) {
    ModelErrors good(JndLine{1.0, 0.0}), bad(JndLine{1.0, 0.0});
    for (int stroke = 0; stroke < 10; ++stroke) {
      for (ModelErrors* one : {&good, &bad}) one->begin_stroke();
      for (int i = 0; i < 50; ++i) {
        good.add(i < 2 ? 2.0 : 0.1, 0.0, false);
        bad.add(i < 2 || (every ? i < 4 : stroke == 0) ? 2.0 : 0.1, 0.0, false);
      }
    }
    const UnitErrors one = good.unit_errors(), other = bad.unit_errors();
    ASSERT_GT(one.within_jnd - other.within_jnd, kLeastShare);
    const auto candidate = [](const UnitErrors& errors, double tick_ns) {
      return Candidate{errors.within_jnd, errors.p99_error_over_jnd, tick_ns, &errors.drawn_strokes};
    };
    EXPECT_EQ(rank({candidate(other, 100.0), candidate(one, 300.0)}).recommended, every ? 1u : 0u);
  }
}

TEST(Recommendation, IsOneLine) {
  EXPECT_EQ(recommendation("trend+greedy-100", {0.9998, 0.4, 331.0}),
            "Use trend+greedy-100: 99.9 % of the test is within one JND, a tick takes 0.33 us.");
  EXPECT_EQ(recommendation("voxel", {0.879, 1.8, 12345.0}),
            "No model is good enough; the best is voxel: 87 % of the test is within one JND, a tick takes 12 us.");
  EXPECT_EQ(share_text(1.0), "100 %");
}

}  // namespace
}  // namespace palpate
