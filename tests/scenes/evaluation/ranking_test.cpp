#include "scenes/evaluation/ranking.h"

#include <gtest/gtest.h>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

TEST(Rank, TakesTheFastestNearTheLowestError) {
  const Ranking ranking = rank({{"greedy", 3.0, 100.0}, {"direct", 0.5, 1000.0}, {"random", 0.6, 200.0}});
  EXPECT_EQ(ranking.best, 1u);
  EXPECT_EQ(ranking.recommended, 2u) << "0.1 JND more is within the margin";
  EXPECT_EQ(ranking.near_best, (std::vector<bool>{false, true, true}));
}

TEST(Rank, SpeedDoesNotOutweighAnErrorBeyondTheMargin) {
  EXPECT_EQ(rank({{"greedy", 0.76, 100.0}, {"greedy", 0.5, 1000.0}}).recommended, 1u);
  EXPECT_EQ(rank({{"greedy", 0.74, 100.0}, {"greedy", 0.5, 1000.0}}).recommended, 0u);
}

// Reports of recordings in which noise had decided: an interval of a time that was too wide, an interval of a
// difference that was too wide, 0.011 JND.
TEST(Rank, NoiseDoesNotDecide) {
  EXPECT_EQ(rank({{"voxel", 1.42, 268.0}, {"trend", 1.46, 229.0}}).recommended, 1u);
  EXPECT_EQ(rank({{"direct", 1.72, 2137.0}, {"greedy", 1.76, 339.0}}).recommended, 1u);
  EXPECT_EQ(rank({{"trend+random", 0.389, 300.0}, {"trend", 0.4, 229.0}}).recommended, 1u);
}

TEST(Rank, WithEqualTimesTheSimplestMethodIsTaken) {
  EXPECT_EQ(rank({{"voxel", 0.5, 100.0}, {"trend", 0.6, 109.0}, {"greedy", 0.55, 105.0}}).recommended, 1u);
  EXPECT_EQ(rank({{"voxel", 0.5, 100.0}, {"trend", 0.6, 111.0}}).recommended, 0u) << "11 % longer";
  EXPECT_EQ(rank({{"trend+direct", 0.5, 100.0},
                  {"trend+voxel", 0.5, 100.0},
                  {"trend+random", 0.5, 100.0},
                  {"kdtree", 0.5, 100.0}})
                .recommended,
            3u);
  EXPECT_EQ(rank({{"another", 0.5, 100.0}, {"direct", 0.6, 100.0}}).recommended, 1u);
  EXPECT_EQ(rank({{"greedy", 0.6, 100.0}, {"trend+greedy", 0.5, 105.0}}).recommended, 1u) << "then the lower error";
}

// For random candidates, no other one near the lowest error is faster by more than a tenth.
TEST(Rank, TheRecommendedModelIsNearTheBestAndFast) {
  RandomStream random(11, 0);
  const char* const methods[] = {"trend", "greedy", "kdtree", "random", "voxel", "direct"};
  for (int round = 0; round < 2000; ++round) {
    std::vector<Candidate> candidates;
    for (int i = 0; i < 8; ++i)
      candidates.push_back({methods[random.index(6)], random.uniform(0.1, 1.5), random.uniform(100.0, 600.0)});
    const Ranking ranking = rank(candidates);
    EXPECT_TRUE(ranking.near_best[ranking.recommended] && ranking.near_best[ranking.best]);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      EXPECT_GE(candidates[i].p99_error_over_jnd, candidates[ranking.best].p99_error_over_jnd);
      if (!ranking.near_best[i]) continue;
      EXPECT_LE(candidates[ranking.recommended].tick_ns, 1.1 * candidates[i].tick_ns) << round;
    }
  }
}

}  // namespace
}  // namespace palpate
