// Fewer subjects than `palpate study recovery` has, and shorter forces; the bounds are
// what chance allows: 24 subjects at four references, three of four intervals at least.
#include "scenes/study/recovery.h"

#include <gtest/gtest.h>

#include "tests/support/study_driving.h"

namespace palpate {
namespace {

bool may_continue(double) { return true; }

TEST(Recovery, IntervalsOfBothProceduresHoldTheTruth) {
  for (const ProcedureKind kind : {ProcedureKind::constant, ProcedureKind::adaptive}) {
    const RecoverySettings settings{kind, 24, 1, test::kQuickTiming, {kJndCriterion, 0.95, 79}};
    const auto rows = measure_recovery(settings, may_continue);
    ASSERT_TRUE(rows.ok()) << rows.error().message;
    ASSERT_EQ(rows->size(), 4u);
    double coverage = 0.0;
    for (const RecoveryRow& row : *rows) {
      EXPECT_EQ(row.subjects, 24);
      EXPECT_GE(row.determined, 22);
      EXPECT_GE(row.coverage, 0.79) << row.reference_N;
      EXPECT_NEAR(row.median_ratio, 1.0, 0.2) << row.reference_N;
      EXPECT_LT(row.rms_log_error, 0.45) << row.reference_N;
      coverage += row.coverage / 4.0;
    }
    EXPECT_GE(coverage, 0.88);
  }
}

TEST(Recovery, CanBeInterrupted) {
  EXPECT_EQ(measure_recovery({}, [](double) { return false; }).error().message, "interrupted");
}

}  // namespace
}  // namespace palpate
