// palpate::fit gives the same models in a separate program as `palpate fit`.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

TEST(FitLibrary, FitsAndReplaysAsTheProgramDoes) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(test::run_palpate(
                {"synth", "--material", "silicone", "--seed", "4", "--seconds", "6", "--out", folder.file("rig.csv")})
                .exit_code,
            0);
  const std::string recording = folder.file("rig.csv");
  const auto run = test::run_program({PALPATE_CPP_PROGRAM, recording, folder.path()});
  ASSERT_EQ(run.exit_code, 0) << run.err;

  const auto fit = test::run_palpate(
      {"fit", "--recording", recording, "--method", "random", "--centres", "40", "--out", folder.file("program.json")});
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  EXPECT_EQ(test::read_text(folder.file("program.json")), test::read_text(folder.file("fitted.json")));

  const auto replay = test::run_palpate(
      {"replay", "--recording", recording, "--model", folder.file("fitted.json"), "--out", folder.file("forces.csv")});
  ASSERT_EQ(replay.exit_code, 0) << replay.err;
  std::istringstream printed(run.out);
  std::ifstream forces(folder.file("forces.csv"));
  std::string line;
  std::getline(forces, line);
  std::size_t rows = 0;
  while (std::getline(forces, line)) {
    std::string force;
    ASSERT_TRUE(std::getline(printed, force)) << "row " << rows;
    // The model's force is the last column.
    EXPECT_EQ(std::stod(line.substr(line.rfind(',') + 1)), std::stod(force)) << "row " << rows;
    ++rows;
  }
  EXPECT_GT(rows, 1000U);
}

}  // namespace
}  // namespace palpate
