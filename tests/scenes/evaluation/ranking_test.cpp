#include "scenes/evaluation/ranking.h"

#include <gtest/gtest.h>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

Timing around(double median_ns) { return {median_ns, 0.98 * median_ns, 1.02 * median_ns, 1.5 * median_ns}; }

// Errors of ten units: `error`, plus a scatter common to all candidates, plus an independent one of size `own`.
Candidate model(double error, double tick_ns, double own = 0.0, std::uint64_t seed = 1) {
  Candidate one{{}, around(tick_ns)};
  one.errors.p99_error_over_jnd = error;
  RandomStream shared(7, 0);
  RandomStream random(seed, 1);
  for (int i = 0; i < 10; ++i) one.errors.unit_p99.push_back(error + 0.3 * shared.normal() + own * random.normal());
  return one;
}

TEST(Rank, TakesTheFastestOfTheQualified) {
  const Ranking ranking = rank({model(3.0, 100.0), model(0.5, 1000.0), model(0.6, 200.0)});
  EXPECT_EQ(ranking.best, 1u);
  EXPECT_EQ(ranking.recommended, 2u) << "0.1 JND more is within the margin";
  EXPECT_EQ(ranking.qualified, (std::vector<bool>{false, true, true}));
}

TEST(Rank, SpeedDoesNotOutweighAnErrorBeyondTheMargin) {
  const Ranking ranking = rank({model(0.9, 100.0), model(0.5, 1000.0)});
  EXPECT_EQ(ranking.recommended, 1u);
  EXPECT_EQ(ranking.qualified, (std::vector<bool>{false, true}));
}

TEST(Rank, AnUncertainDifferenceDoesNotQualify) {
  // The mean difference is 0.1 JND, but units scatter by 0.5: the upper bound exceeds the margin.
  EXPECT_EQ(rank({model(0.6, 100.0, 0.5, 2), model(0.5, 1000.0, 0.5, 3)}).recommended, 1u);
}

TEST(Rank, WithTooFewUnitsTheDifferenceItselfCounts) {
  Candidate one = model(0.6, 100.0);
  Candidate other = model(0.5, 1000.0);
  one.errors.unit_p99.resize(2);
  other.errors.unit_p99.resize(2);
  EXPECT_EQ(rank({one, other}).recommended, 0u);
}

TEST(Rank, TimesThatOverlapAreEqual) {
  EXPECT_EQ(rank({model(0.6, 100.0), model(0.5, 101.0)}).recommended, 1u) << "then the smaller error counts";
}

// For random candidates, no other one is faster and has a smaller error.
TEST(Rank, NeverRecommendsADominatedModel) {
  RandomStream random(11, 0);
  for (int round = 0; round < 2000; ++round) {
    std::vector<Candidate> candidates;
    for (int i = 0; i < 8; ++i) {
      candidates.push_back(model(random.uniform(0.1, 1.5), random.uniform(100.0, 600.0), random.uniform(0.0, 0.6),
                                 static_cast<std::uint64_t>(8 * round + i + 1)));
    }
    const std::size_t taken = rank(candidates).recommended;
    for (const Candidate& other : candidates) EXPECT_FALSE(dominates(other, candidates[taken])) << round;
  }
}

}  // namespace
}  // namespace palpate
