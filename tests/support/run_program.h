// Runs a program and returns its output, for tests of whole programs.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace palpate::test {

struct ProgramRun {
  int exit_code = -1;  // 128 + n when signal n ended it
  std::string out;
  std::string err;
};

// Runs `command` (the program's path and its arguments, no shell) with an empty
// standard input; `environment` holds "NAME=value" additions to that of this
// process. The exit code is 127 if it cannot be started. Blocks until it ends.
ProgramRun run_program(const std::vector<std::string>& command, const std::vector<std::string>& environment = {});

// The same for the built `palpate` with `arguments`.
ProgramRun run_palpate(const std::vector<std::string>& arguments, const std::vector<std::string>& environment = {});

// The same; throws the error line if the exit code is not 0, which fails the test.
ProgramRun must_run(const std::vector<std::string>& arguments);

// Success if the program ended with `exit_code` and printed nothing but one error line that has `parts` in this order.
testing::AssertionResult is_refused(const ProgramRun& run, int exit_code, const std::vector<std::string>& parts);
// The same for a run of `palpate`.
testing::AssertionResult fails(int exit_code, const std::vector<std::string>& arguments,
                               const std::vector<std::string>& parts = {});

}  // namespace palpate::test
