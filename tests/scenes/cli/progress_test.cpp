#include "scenes/cli/verbs.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <limits>

namespace palpate::cli {
namespace {

TEST(Progress, HasShareAndRemainingTime) {
  EXPECT_EQ(progress_text("fitting", 0.25, 10.0), "fitting   25 %  30 s left");
  EXPECT_EQ(progress_text("fitting", 1.0, 10.0), "fitting  100 %  0 s left");
}

TEST(Progress, DoesNotGuessTooEarly) {
  EXPECT_EQ(progress_text("fitting", 0.5, 0.2), "fitting   50 %");
  EXPECT_EQ(progress_text("fitting", 0.01, 10.0), "fitting    1 %");
}

TEST(Progress, SurvivesFractionsOutOfRange) {
  EXPECT_EQ(progress_text("a", -1.0, 0.0), "a    0 %");
  EXPECT_EQ(progress_text("a", 7.0, 0.0), "a  100 %");
  EXPECT_EQ(progress_text("a", std::numeric_limits<double>::quiet_NaN(), 5.0), "a    0 %");
}

TEST(Progress, FirstInterruptAsksToStop) {
  ProgressLine line("fitting");
  EXPECT_TRUE(line.update(0.1));
  raise(SIGINT);
  EXPECT_FALSE(line.update(0.2));
  EXPECT_EQ(stop_requested(), SIGINT);
}

}  // namespace
}  // namespace palpate::cli
