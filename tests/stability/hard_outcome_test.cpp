#include "tests/stability/hard_outcome.h"
#include "tests/support/message_parts.h"

#include <gtest/gtest.h>

#include <limits>

namespace palpate {
namespace {

TEST(HardOutcome, HasShareAndWorstError) {
  OutcomeCounter near;
  near.add(1.0, 1.05, 0.0, 2.0);
  EXPECT_TRUE(test::has_parts(near.finish({}).outcome, {"0.38 JND"}));
  OutcomeCounter far = near;
  far.add(1.9, 0.0, 0.0, 2.0);
  const HardCaseResult result = far.finish({});
  EXPECT_TRUE(test::has_parts(result.outcome, {"50.0 %", "29.2 JND"}));
  EXPECT_TRUE(result.safe);
  EXPECT_EQ(result.within_jnd, 0.5);
}

TEST(HardOutcome, OutOfBoundsOrNotFiniteIsNotSafe) {
  OutcomeCounter counter;
  counter.add(2.5, 0.0, 0.0, 2.0);
  HardCaseResult result = counter.finish({});
  EXPECT_FALSE(result.safe);
  EXPECT_TRUE(test::has_parts(result.outcome, {"1 of 1", "2.5 N"}));
  counter.add(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0, 2.0);
  result = counter.finish({});
  EXPECT_FALSE(result.safe);
  EXPECT_TRUE(test::has_parts(result.outcome, {"1 of 2", "finite"}));
}

TEST(HardOutcome, WithoutATruthOnlyTheBoundsCount) {
  OutcomeCounter counter;
  counter.add_bounded(1.0, 0.0, 2.0);
  EXPECT_TRUE(test::has_parts(counter.finish({}).outcome, {"1 values"}));
  EXPECT_TRUE(counter.finish({}).safe);
}

TEST(HardOutcome, ARefusalIsSafe) {
  const HardCaseResult result = refused({}, "nothing to learn");
  EXPECT_TRUE(result.safe);
  EXPECT_EQ(result.outcome, "refused: nothing to learn");
}

}  // namespace
}  // namespace palpate
