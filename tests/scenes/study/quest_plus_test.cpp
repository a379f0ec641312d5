#include "scenes/study/quest_plus.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/tick/jnd.h"
#include "engine/base/random_stream.h"
#include "scenes/study/study_plan.h"

namespace palpate {
namespace {

TEST(QuestPlus, KnowsLittleBeforeTheFirstAnswer) {
  for (const std::size_t reference : {0u, 3u}) {
    const Estimate prior = QuestPlus().relative_jnd(reference, kJndCriterion, 0.95);
    EXPECT_LT(prior.low, 0.1);
    EXPECT_GT(prior.high, 5.0 * prior.low);
  }
  EXPECT_GT(QuestPlus().relative_jnd(0, 0.9, 0.95).value, QuestPlus().relative_jnd(0, 0.75, 0.95).value);
}

TEST(QuestPlus, ApproachesTheTruthAndNarrows) {
  for (const JndLine& truth : {JndLine{0.065, 0.0633}, JndLine{0.03, 0.12}}) {
    RandomStream random(5, 1);
    QuestPlus quest;
    double early_width = 0.0;
    for (int i = 0; i < 400; ++i) {
      const auto reference = static_cast<std::size_t>(i % 4);
      const double force_N = kReferenceForces_N[reference];
      const PsychometricFunction subject{normal_quantile(0.75) * force_N / truth.at(force_N), 0.3, 0.02};
      const bool larger = random.index(2) == 1, first = random.index(2) == 1;
      const double difference = (larger ? 1.0 : -1.0) * quest.next_difference(reference, larger, first);
      ASSERT_LE(std::abs(difference), 0.4 + 1e-9);
      quest.answered(reference, difference, first, random.uniform(0.0, 1.0) < subject.at(difference, first));
      const Estimate now = quest.relative_jnd(0, kJndCriterion, 0.95);
      if (i == 20) early_width = now.high / now.low;
    }
    for (std::size_t reference = 0; reference < 4; ++reference) {
      const double force_N = kReferenceForces_N[reference];
      const Estimate end = quest.relative_jnd(reference, kJndCriterion, 0.95);
      EXPECT_GT(truth.at(force_N) / force_N, end.low) << force_N;
      EXPECT_LT(truth.at(force_N) / force_N, end.high) << force_N;
      EXPECT_LT(end.high / end.low, 2.5) << force_N;
      EXPECT_LT(end.high / end.low, early_width);
    }
  }
}

TEST(QuestPlus, AsksSensitiveSubjectsForSmallDifferences) {
  QuestPlus sharp, dull;
  for (int i = 0; i < 40; ++i) {
    const auto reference = static_cast<std::size_t>(i % 4);
    const bool larger = i % 8 < 4, first = i % 16 < 8;
    const double side = larger ? 1.0 : -1.0;
    sharp.answered(reference, side * sharp.next_difference(reference, larger, first), first, larger);
    dull.answered(reference, side * dull.next_difference(reference, larger, first), first, i % 3 == 0);
  }
  EXPECT_LE(sharp.next_difference(3, true, false), 0.15);
  EXPECT_GE(dull.next_difference(3, true, false), 0.3);
  EXPECT_LT(sharp.relative_jnd(3, 0.75, 0.95).high, dull.relative_jnd(3, 0.75, 0.95).value);
}

// A smaller comparison in one order is the mirror image of a larger one in the other.
TEST(QuestPlus, MirroredQuestionsTellAsMuch) {
  QuestPlus one, mirrored;
  for (int i = 0; i < 12; ++i) {
    const auto reference = static_cast<std::size_t>(i % 4);
    const bool larger = i % 3 == 0, first = i % 2 == 0, judged_larger = i % 5 < 3;
    const double magnitude = one.next_difference(reference, larger, first);
    ASSERT_EQ(magnitude, mirrored.next_difference(reference, !larger, !first));
    one.answered(reference, larger ? magnitude : -magnitude, first, judged_larger);
    mirrored.answered(reference, larger ? -magnitude : magnitude, !first, !judged_larger);
  }
  EXPECT_NEAR(one.relative_jnd(2, 0.75, 0.95).value, mirrored.relative_jnd(2, 0.75, 0.95).value, 1e-12);
}

}  // namespace
}  // namespace palpate
