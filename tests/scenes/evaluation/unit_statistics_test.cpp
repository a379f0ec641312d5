#include "scenes/evaluation/unit_statistics.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

// The published table of Student's t, one-sided 5 and 2.5 %.
TEST(StudentT, AgreesWithThePublishedTable) {
  EXPECT_NEAR(student_t(0.05, 1), 6.314, 5e-4);
  EXPECT_NEAR(student_t(0.05, 2), 2.920, 5e-4);
  EXPECT_NEAR(student_t(0.025, 3), 3.182, 5e-4);
  EXPECT_NEAR(student_t(0.025, 10), 2.228, 5e-4);
  EXPECT_NEAR(student_t(0.05, 29), 1.699, 5e-4);
  EXPECT_NEAR(student_t(0.025, 120), 1.980, 5e-4);
}

TEST(UnitStatistics, ARatioOfEqualUnitsIsAMean) {
  const std::vector<double> shares{0.5, 0.7, 0.9, 0.6};
  const std::vector<double> within{50.0, 70.0, 90.0, 60.0};
  EXPECT_NEAR(ratio_standard_error(within, {100.0, 100.0, 100.0, 100.0}), standard_error(shares), 1e-12);
}

}  // namespace
}  // namespace palpate
