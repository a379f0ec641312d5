// The whole program: exit codes and output.
#include <gtest/gtest.h>

#include "tests/support/message_parts.h"
#include "tests/support/run_program.h"

namespace palpate {
namespace {

using test::run_palpate;
using test::run_program;

TEST(Main, HelpAndVersionGoToStandardOutput) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"--version"}, {"scenes", "--help"}, {"devices", "--help"}}) {
    const auto run = test::must_run(arguments);
    EXPECT_FALSE(run.out.empty());
    EXPECT_EQ(run.err, "");
  }
  EXPECT_EQ(run_palpate({"--version"}).out.rfind("palpate ", 0), 0u);
}

TEST(Main, WrongUsageIsOneLineThatNamesTheVerbs) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{}, {"dance"}, {"--dance"}, {""}}) {
    EXPECT_TRUE(test::fails(2, arguments, {"known verbs: ", "scenes, devices"}));
  }
}

TEST(Main, UnknownOptionPointsToTheVerbsHelp) {
  EXPECT_TRUE(test::fails(2, {"scenes", "--dance"}, {"error: ", "--dance", "palpate scenes", "--help"}));
}

TEST(Main, ScenesListsEveryScene) {
  const auto run = test::must_run({"scenes"});
  EXPECT_EQ(run.err, "");
  for (const char* name : {"silicone_block", "button", "foam_block", "elastic_block", "stiff_block", "skin"}) {
    EXPECT_TRUE(test::has_parts(run.out, {name}));
  }
}

TEST(Main, ScenesReadsTheSameInEveryLocale) {
  EXPECT_EQ(run_palpate({"scenes"}, {"LC_ALL=de_DE.UTF-8"}).out, run_palpate({"scenes"}).out);
}

TEST(Main, ResultsThatCannotBePrintedAreAFailure) {
  const auto run = run_program({"/bin/sh", "-c", "\"$0\" scenes > /dev/full", PALPATE_BINARY});
  EXPECT_TRUE(test::is_refused(run, 1, {"standard output\n"}));
}

}  // namespace
}  // namespace palpate
