#include "tests/stability/hard_outcome.h"

#include <gtest/gtest.h>

#include <limits>

namespace palpate {
namespace {

TEST(HardOutcome, SaysHowNearTheTruth) {
  OutcomeCounter near;
  near.add(1.0, 1.05, 0.0, 2.0);
  EXPECT_EQ(near.finish({}).outcome, "within the JND, worst error 0.38 JND");
  OutcomeCounter far = near;
  far.add(1.9, 0.0, 0.0, 2.0);
  const HardCaseResult result = far.finish({});
  EXPECT_EQ(result.outcome, "bounded: 50.0 % within the JND, worst error 29.2 JND");
  EXPECT_TRUE(result.safe);
  EXPECT_EQ(result.within_jnd, 0.5);
}

TEST(HardOutcome, OutOfBoundsOrNotFiniteIsNotSafe) {
  OutcomeCounter counter;
  counter.add(2.5, 0.0, 0.0, 2.0);
  HardCaseResult result = counter.finish({});
  EXPECT_FALSE(result.safe);
  EXPECT_EQ(result.outcome, "1 of 1 values out of bounds, up to 2.5 N");
  counter.add(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0, 2.0);
  result = counter.finish({});
  EXPECT_FALSE(result.safe);
  EXPECT_EQ(result.outcome, "1 of 2 values are not finite");
}

TEST(HardOutcome, WithoutATruthOnlyTheBoundsCount) {
  OutcomeCounter counter;
  counter.add_bounded(1.0, 0.0, 2.0);
  EXPECT_EQ(counter.finish({}).outcome, "finite and within bounds, 1 values");
  EXPECT_TRUE(counter.finish({}).safe);
}

TEST(HardOutcome, ARefusalIsSafe) {
  const HardCaseResult result = refused({}, "nothing to learn");
  EXPECT_TRUE(result.safe);
  EXPECT_EQ(result.outcome, "refused: nothing to learn");
}

}  // namespace
}  // namespace palpate
