#include "scenes/live/evaluation_time.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(EvaluationTime, IsTheMedianOfTheLastSecond) {
  EvaluationTime time;
  EXPECT_EQ(time.median_ns(), 0.0);
  time.add(80.0F);
  EXPECT_EQ(time.median_ns(), 80.0);
  for (int i = 0; i < 999; ++i) time.add(i % 10 == 0 ? 5000.0F : 100.0F);
  EXPECT_EQ(time.median_ns(), 100.0) << "not moved by what is rare";
  for (int i = 0; i < 1000; ++i) time.add(70.0F);
  EXPECT_EQ(time.median_ns(), 70.0) << "the old ones are forgotten";
}

}  // namespace
}  // namespace palpate
