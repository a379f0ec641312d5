#include "tests/support/run_program.h"

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

TEST(RunProgram, CapturesBothStreamsAndTheExitCode) {
  const ProgramRun run = run_program({"/bin/sh", "-c", "echo out; echo err >&2; exit 3"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(run.out, "out\n");
  EXPECT_EQ(run.err, "err\n");
}

TEST(RunProgram, SurvivesMoreThanAPipeHolds) {
  const ProgramRun run = run_program({"/bin/sh", "-c", "head -c 300000 /dev/zero >&2; head -c 300000 /dev/zero"});
  EXPECT_EQ(run.out.size(), 300000u);
  EXPECT_EQ(run.err.size(), 300000u);
}

TEST(RunProgram, ReportsSignalsAndMissingPrograms) {
  EXPECT_EQ(run_program({"/bin/sh", "-c", "kill -9 $$"}).exit_code, 128 + 9);
  EXPECT_EQ(run_program({"/none/such"}).exit_code, 127);
}

TEST(RunProgram, PassesTheEnvironment) {
  EXPECT_EQ(run_program({"/bin/sh", "-c", "echo $GREETING"}, {"GREETING=hello"}).out, "hello\n");
}

}  // namespace
}  // namespace palpate::test
