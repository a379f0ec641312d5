// The program palpate synth.
#include <gtest/gtest.h>

#include "engine/recording/recording.h"
#include "scenes/material/material.h"
#include "tests/support/message_parts.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::run_palpate;

TEST(Synth, ListsTheMaterialsWithTheirRelaxationTimes) {
  const auto run = test::must_run({"synth", "--list"});
  EXPECT_EQ(run.err, "");
  for (const Material& material : materials())
    EXPECT_TRUE(test::has_parts(run.out, {std::string(material.name), std::string(material.relaxation_times)}));
}

TEST(Synth, WritesOverNothingWithoutForce) {
  const test::TemporaryFolder folder;
  const std::string path = folder.with_file("kept.csv", "mine\n");
  const std::vector<std::string> command = {"synth", "--material", "stiff", "--seconds", "1", "--out", path};
  EXPECT_TRUE(test::fails(1, command, {"--force"}));
  EXPECT_EQ(test::read_text(path), "mine\n");
  std::vector<std::string> forced = command;
  forced.push_back("--force");
  EXPECT_EQ(run_palpate(forced).exit_code, 0);
  EXPECT_NE(test::read_text(path), "mine\n");
}

TEST(Synth, WrongUsageEndsWithTwoAndLeavesNoFile) {
  const test::TemporaryFolder folder;
  const std::string out = folder.file("x.csv");
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"--material", "silicone"},
      {"--out", out},
      {"--material", "jelly", "--out", out},
      {"--material", "silicone", "--out", out, "--seconds", "0"},
      {"--material", "silicone", "--out", out, "--seconds", "soon"},
      {"--material", "silicone", "--out", out, "--rate", "9"},
      {"--material", "silicone", "--out", out, "--seed", "-1"},
      {"--material", "silicone", "--out", out, "--seed", "one"},
      {"--material", "silicone", "--out", out, "--seed", "99999999999999999999"},
  };
  for (std::vector<std::string> arguments : wrong) {
    arguments.insert(arguments.begin(), "synth");
    EXPECT_TRUE(test::fails(2, arguments));
  }
  EXPECT_TRUE(folder.entries().empty());
}

}  // namespace
}  // namespace palpate
