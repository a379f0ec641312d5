#include "scenes/cli/progress.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

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

TEST(Progress, SoDoesARequestToTerminate) {
  ProgressLine line("fitting");
  raise(SIGTERM);
  EXPECT_FALSE(line.update(0.2));
  EXPECT_EQ(stop_requested(), SIGTERM);
}

TEST(Progress, ANewLineStartsUninterrupted) {
  {
    const ProgressLine line("first");
    raise(SIGINT);
  }
  ProgressLine line("second");
  EXPECT_TRUE(line.update(0.0));
}

// How a child process ends that sends itself SIGINT `times` times, while the line
// exists or after it. 0: normal exit; else the signal.
int end_after_interrupts(int times, bool line_alive) {
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGINT, SIG_DFL);
    {
      const ProgressLine line("fitting");
      for (int i = 0; line_alive && i < times; ++i) raise(SIGINT);
    }
    for (int i = 0; !line_alive && i < times; ++i) raise(SIGINT);
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status);
}

TEST(Progress, SecondInterruptEndsTheProgram) {
  EXPECT_EQ(end_after_interrupts(1, true), 0);
  EXPECT_EQ(end_after_interrupts(2, true), SIGINT);
}

TEST(Progress, InterruptsEndTheProgramAgainAfterTheLine) { EXPECT_EQ(end_after_interrupts(1, false), SIGINT); }

}  // namespace
}  // namespace palpate::cli
