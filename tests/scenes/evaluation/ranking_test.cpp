#include "scenes/evaluation/ranking.h"

#include <gtest/gtest.h>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

// Twenty strokes; a model's error is `scale` times what they have in common.
Evidence evidence(double scale, double more_N) {
  ModelErrors errors(JndLine{0.1, 0.0});
  RandomStream random(5, 0);
  for (int stroke = 0; stroke < 20; ++stroke) {
    errors.begin_block(true);
    const double common_N = 0.1 * random.uniform(0.0, 1.0);
    for (int i = 0; i < 20; ++i) errors.add(1.0 + scale * common_N + more_N, 1.0, false);
  }
  return errors.evidence();
}

TEST(Rank, TakesTheCheapestOfTheTied) {
  const Evidence dear = evidence(1.0, 0.0);
  const Evidence cheap = evidence(-1.0, 1e-9);  // as large, and rounded up
  const Evidence bad = evidence(3.0, 0.0);
  const Ranking ranking = rank({{&bad, 0}, {&dear, 100}, {&cheap, 20}});
  EXPECT_EQ(ranking.chosen, 2u);
  EXPECT_EQ(ranking.tied, (std::vector<std::size_t>{1, 2}));
}

TEST(Rank, CheapnessDoesNotOutweighAnErrorThatCanBeTold) {
  const Evidence good = evidence(1.0, 0.0);
  const Evidence bad = evidence(1.0, 0.005);
  const Ranking ranking = rank({{&bad, 0}, {&good, 1000}});
  EXPECT_EQ(ranking.chosen, 1u);
  EXPECT_EQ(ranking.best, 1u);
  EXPECT_EQ(ranking.tied, (std::vector<std::size_t>{1}));
}

TEST(Rank, WhatNoHandNoticesIsTied) {
  const Evidence good = evidence(0.1, 0.0);
  const Evidence unnoticed = evidence(0.1, 0.005);  // told from the good one, and far within the JND
  const Ranking ranking = rank({{&unnoticed, 0}, {&good, 1000}});
  EXPECT_EQ(ranking.best, 1u);
  EXPECT_EQ(ranking.chosen, 0u);
}

}  // namespace
}  // namespace palpate
