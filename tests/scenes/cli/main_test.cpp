// The whole program: exit codes and output.
#include <gtest/gtest.h>

#include "tests/support/message_parts.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

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

TEST(Main, HelpIsAVerbToo) {
  EXPECT_EQ(test::must_run({"help"}).out, test::must_run({"--help"}).out);
  EXPECT_EQ(test::must_run({"help", "fit"}).out, test::must_run({"fit", "--help"}).out);
  EXPECT_TRUE(test::fails(2, {"help", "fti"}, {"verb \"fti\"; did you mean fit?"}));
}

TEST(Main, WrongUsageIsOneLineThatNamesTheVerbs) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{}, {"dance"}, {"--dance"}, {""}}) {
    EXPECT_TRUE(test::fails(2, arguments, {"known verbs: ", "scenes, devices"}));
  }
}

// CLI11 reports a missing option before an unknown one.
TEST(Main, MistypedOptionIsNamedWithTheNearestOne) {
  EXPECT_TRUE(
      test::fails(2, {"fit", "--recoding", "a.csv"}, {"--recoding", "did you mean --recording?", "palpate fit"}));
  EXPECT_TRUE(test::fails(2, {"study", "analyse", "a.csv", "--pagn"}, {"--pagn", "did you mean --pang?"}));
  EXPECT_TRUE(test::fails(2, {"study", "simulat"}, {"verb \"simulat\"; did you mean simulate?", "palpate study"}));
  EXPECT_TRUE(test::fails(2, {"chek", "a.csv"}, {"verb \"chek\"; did you mean check?", "known verbs: "}));
  EXPECT_TRUE(test::fails(2, {"replay", "--modle=m.json"}, {"--modle", "did you mean --model?"}));
}

TEST(Main, WrongUsageSaysWhatIsWrong) {
  const test::TemporaryFolder folder;
  const std::string out = folder.file("x.csv");
  EXPECT_TRUE(test::fails(2, {"fit", "--recording", "--out", "m.json"}, {"--recording: found no value, expected one"}));
  EXPECT_TRUE(test::fails(2, {"synth", "--material", "foam", "--seconds", "abc", "--out", out},
                          {"found \"abc\", expected a number from 0.1 to 1000000"}));
  EXPECT_TRUE(test::fails(2, {"study", "simulate", "--subjects", "abc", "--out", out},
                          {"expected a number from 1 to 99", "palpate study simulate --help explains"}));
  EXPECT_TRUE(test::fails(2, {"check", out, "--scene", "no_such"}, {"unknown scene \"no_such\"; known scenes: "}));
  EXPECT_TRUE(test::fails(2, {"record", "--device", "no_such", "--out", out}, {"unknown device \"no_such\""}));
  EXPECT_TRUE(test::fails(2, {"replay", "--recording", out, "--model", "m.json", "--plot", "x.bmp"},
                          {"found x.bmp, expected a file that ends in .svg or .png"}));
  EXPECT_TRUE(test::has_parts(test::must_run({"help", "fit"}).out, {"palpate fit", "--recording"}));
}

TEST(Main, EveryVerbHasAnExampleAndTheVersionSaysWhatComputes) {
  for (const char* verb : {"synth", "import", "check", "fit", "replay", "export", "report", "paper", "hard", "record",
                           "scenes", "devices", "study"}) {
    EXPECT_TRUE(test::has_parts(test::must_run({verb, "--help"}).out, {"Example:\n  palpate " + std::string(verb)}));
  }
  for (const std::string verb : {"analyse", "simulate"}) {
    EXPECT_TRUE(test::has_parts(test::must_run({"study", verb, "--help"}).out, {"Example:\n  palpate study " + verb}));
  }
  EXPECT_TRUE(test::has_parts(run_palpate({"--version"}).out, {"palpate ", "commit ", "BLAS", "vectors "}));
}

TEST(Main, HardRefusesAFolderThatExistsBeforeItRuns) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(test::fails(1, {"hard", "--out", folder.path()}, {folder.path() + " exists", "--force"}));
}

TEST(Main, ScenesListsEveryScene) {
  const auto run = test::must_run({"scenes"});
  EXPECT_EQ(run.err, "");
  for (const char* name : {"silicone_block", "button", "foam_block", "elastic_block", "stiff_block", "skin"}) {
    EXPECT_TRUE(test::has_parts(run.out, {name}));
  }
}

TEST(Main, ResultsThatCannotBePrintedAreAFailure) {
  const auto run = run_program({"/bin/sh", "-c", "\"$0\" scenes > /dev/full", PALPATE_BINARY});
  EXPECT_TRUE(test::is_refused(run, 1, {"standard output\n"}));
}

}  // namespace
}  // namespace palpate
