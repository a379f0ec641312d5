// The program palpate study, from the first trial to errors of a scene in terms of the measured JND.
#include <gtest/gtest.h>

#include <filesystem>

#include "scenes/scene/scene.h"
#include "scenes/study/study_file.h"
#include "tests/support/message_parts.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::run_palpate;

TEST(Study, MeasuresTheJndOfAScene) {
  const test::TemporaryFolder folder;
  const std::string out = folder.file("study");
  const std::vector<std::string> simulate = {"study", "simulate", "--subjects", "3", "--seed", "2", "--out", out};
  const auto run = test::must_run(simulate);
  EXPECT_EQ(run.err, "");
  EXPECT_TRUE(test::has_parts(run.out, {"conservative "}));
  for (const char* name : {"S01.csv", "S03.csv", "results.csv", "jnd.json"}) {
    EXPECT_TRUE(std::filesystem::exists(out + "/" + name)) << name;
  }
  EXPECT_EQ(read_study(out + "/S02.csv")->records.size(), 328u);
  const auto again = run_palpate(simulate);
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_TRUE(test::has_parts(again.err, {"error: ", out, "/S01.csv", "--force"}));

  // The same files give the same result.
  const auto analysed = test::must_run(
      {"study", "analyse", out + "/S01.csv", out + "/S02.csv", out + "/S03.csv", "--out", folder.file("again")});
  EXPECT_EQ(analysed.out, run.out);
  const auto json = test::must_run({"study", "analyse", out + "/S01.csv", out + "/S02.csv", out + "/S03.csv", "--json",
                                    "--force", "--out", folder.file("again")});
  EXPECT_EQ(json.out, test::read_text(out + "/jnd.json"));
  EXPECT_EQ(test::read_text(folder.file("again/jnd.json")), test::read_text(out + "/jnd.json"));

  const auto scene = test::must(load_scene("silicone_block"));
  std::string text = test::read_text(std::string(PALPATE_SOURCE_DIR) + "/assets/scenes/silicone_block.json");
  const std::size_t begin = text.find("\"jnd\""), end = text.find('}', begin);
  text.replace(begin, end + 1 - begin, "\"jnd_file\": \"jnd.json\"");
  const auto judged = test::must(parse_scene(text, out + "/silicone_block.json"));
  EXPECT_EQ(judged.jnd.offset_N, read_jnd_file(out + "/jnd.json")->offset_N);
  EXPECT_NE(judged.jnd.weber_fraction, scene.jnd.weber_fraction);
}

TEST(Study, SimulatedSubjectsDiscriminateStrokes) {
  const test::TemporaryFolder folder;
  const std::string foam = folder.file("foam.csv"), out = folder.file("out");
  ASSERT_EQ(run_palpate({"synth", "--material", "foam", "--seed", "2", "--seconds", "20", "--out", foam}).exit_code, 0);
  const auto run = test::must_run(
      {"study", "simulate", "--discriminate", foam, "--model", "greedy", "--subjects", "2", "--out", out});
  EXPECT_EQ(run.err, "");
  EXPECT_TRUE(test::has_parts(
      run.out, {"comparison   greedy-100\nstroke       foam, ", "Predicted above the JND", "one JND: consistent."}))
      << "a model of silicone against foam: " << run.out;
  EXPECT_EQ(test::must(read_study(out + "/S02.csv")).records.size(), 104u);

  const auto again =
      test::must_run({"study", "analyse", out + "/S01.csv", out + "/S02.csv", "--out", folder.file("again")});
  EXPECT_EQ(again.out, run.out);
  EXPECT_EQ(test::read_text(folder.file("again/results.csv")), test::read_text(out + "/results.csv"));
}

TEST(Study, RecordsTheSceneWithoutAFile) {
  const test::TemporaryFolder folder;
  const auto run =
      test::must_run({"study", "simulate", "--discriminate", "--subjects", "1", "--out", folder.file("out")});
  EXPECT_TRUE(
      test::has_parts(run.out, {"reference    recorded force\ncomparison   trend+greedy-100\nstroke       silicone_2, ",
                                "Predicted below the JND"}));
}

TEST(Study, RefusesWrongUsage) {
  EXPECT_EQ(run_palpate({"study"}).exit_code, 2);
  EXPECT_EQ(run_palpate({"study", "simulate"}).exit_code, 2);
  EXPECT_EQ(run_palpate({"study", "recovery"}).exit_code, 2);
  EXPECT_EQ(run_palpate({"study", "analyse", "--out", "x"}).exit_code, 2);
  for (const char* option : {"--offset", "--weber", "--bias", "--lapse", "--seed"}) {
    EXPECT_EQ(run_palpate({"study", "simulate", "--out", "x", option, "nan"}).exit_code, 2) << option;
  }
  EXPECT_EQ(run_palpate({"study", "simulate", "--out", "x", "--seed", "-1"}).exit_code, 2);
  EXPECT_EQ(run_palpate({"study", "simulate", "--out", "x", "--model", "greedy"}).exit_code, 2)
      << "needs --discriminate";
  EXPECT_TRUE(test::fails(1, {"study", "analyse", "/none/S01.csv", "--out", "/none/out"}, {"/none/S01.csv"}));
}

}  // namespace
}  // namespace palpate
