#include "scenes/study/quest_plus.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/random_stream.h"

namespace palpate {
namespace {

TEST(QuestPlus, KnowsNothingBeforeTheFirstAnswer) {
  const Estimate prior = QuestPlus().relative_jnd(kJndCriterion, 0.95);
  EXPECT_NEAR(prior.value, 0.6745 * std::sqrt(0.03 * 2.0), 1e-3);
  EXPECT_LT(prior.low, 0.03);
  EXPECT_GT(prior.high, 1.1);
}

TEST(QuestPlus, ApproachesTheTruthAndNarrows) {
  for (const double jnd : {0.07, 0.13, 0.3}) {
    RandomStream random(5, 1);
    const PsychometricFunction truth{0.0, normal_quantile(0.75) / jnd, 0.3, 0.0};
    QuestPlus quest;
    double width = 0.0;
    for (int i = 1; i <= 400; ++i) {
      const bool larger = random.index(2) == 1, first = random.index(2) == 1;
      const double difference = (larger ? 1.0 : -1.0) * quest.next_difference(larger, first);
      quest.answered(difference, first, random.uniform(0.0, 1.0) < truth.at(difference, first));
      const Estimate now = quest.relative_jnd(kJndCriterion, 0.95);
      if (i == 20) width = now.high - now.low;
    }
    const Estimate end = quest.relative_jnd(kJndCriterion, 0.95);
    EXPECT_LT(end.high - end.low, 0.5 * width) << jnd;
    EXPECT_GT(jnd, end.low) << jnd;
    EXPECT_LT(jnd, end.high) << jnd;
    EXPECT_LT(end.high / end.low, 1.9) << jnd;
  }
}

TEST(QuestPlus, AsksSensitiveSubjectsForSmallDifferences) {
  QuestPlus sharp, dull;
  for (int i = 0; i < 20; ++i) {
    const bool larger = i % 2 == 0, first = i % 4 < 2;
    const double side = larger ? 1.0 : -1.0;
    sharp.answered(side * sharp.next_difference(larger, first), first, larger);
    dull.answered(side * dull.next_difference(larger, first), first, i % 3 == 0);
  }
  EXPECT_LE(sharp.next_difference(true, false), 0.15);
  EXPECT_GE(dull.next_difference(true, false), 0.3);
  EXPECT_LT(sharp.relative_jnd(0.75, 0.95).high, dull.relative_jnd(0.75, 0.95).value);
}

}  // namespace
}  // namespace palpate
