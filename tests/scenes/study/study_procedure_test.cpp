#include "scenes/study/study_procedure.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(StudyProcedure, ConstantStimuliFollowThePlan) {
  const auto procedure = StudyProcedure::create(ProcedureKind::constant, "S01");
  const std::vector<StudyTrial> plan = plan_constant_trials("S01");
  ASSERT_EQ(procedure->trial_count(), 320u);
  for (const StudyTrial& trial : plan) {
    ASSERT_EQ(procedure->next(), trial);
    procedure->answered(true);
  }
  EXPECT_TRUE(procedure->done());
}

TEST(StudyProcedure, AdaptiveStaysWithinTheRangeAndRepeatsItself) {
  const auto one = StudyProcedure::create(ProcedureKind::adaptive, "S01");
  const auto again = StudyProcedure::create(ProcedureKind::adaptive, "S01");
  while (!one->done()) {
    const StudyTrial trial = one->next();
    ASSERT_EQ(trial, again->next());
    const double ratio = trial.comparison_N / trial.reference_N;
    EXPECT_GE(ratio, 0.6 - 1e-3);
    EXPECT_LE(ratio, 1.4 + 1e-3);
    EXPECT_NE(trial.comparison_N, trial.reference_N);
    const bool larger = trial.comparison_N > trial.reference_N;
    one->answered(larger);
    again->answered(larger);
  }
  EXPECT_EQ(one->answered_count(), 80u);
}

TEST(StudyProcedure, KnowsItsNames) {
  EXPECT_EQ(*find_procedure("constant"), ProcedureKind::constant);
  EXPECT_EQ(*find_procedure(procedure_name(ProcedureKind::adaptive)), ProcedureKind::adaptive);
  EXPECT_EQ(find_procedure("staircase").error().message,
            "found the procedure \"staircase\", expected constant, adaptive or discriminate");
}

}  // namespace
}  // namespace palpate
