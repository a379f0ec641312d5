// The program palpate fit: exit codes, messages, files.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "models/fit/fit.h"
#include "models/model/file/model_io.h"
#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate::test {
namespace {

using Arguments = std::vector<std::string>;

class FitVerb : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(write_recording(recording(), example_recording(1000, 250.0), {}, false).ok()); }

  std::string recording() const { return folder_.file("press.csv"); }
  std::string out() const { return folder_.file("model.json"); }

  // `palpate fit` with default options, which those of `more` replace.
  ProgramRun fit(const Arguments& more, const std::string& method = "trend+greedy") const {
    Arguments arguments = {"fit"};
    std::vector<std::pair<std::string, std::string>> defaults = {
        {"--recording", recording()}, {"--method", method}, {"--out", out()}};
    const auto plan = parse_plan(method);
    if (plan.ok() && plan->selects_centres()) defaults.emplace_back("--centres", "20");
    for (const auto& [option, value] : defaults) {
      if (std::find(more.begin(), more.end(), option) == more.end()) arguments.insert(arguments.end(), {option, value});
    }
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_palpate(arguments);
  }

  // Expects that the run made a model that loads.
  void expect_model(const ProgramRun& run) const {
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_EQ(run.err, "");
    EXPECT_TRUE(load_model(out()).ok());
  }

  // Expects that the run ended with one error line and left no file.
  void expect_refused(const ProgramRun& run, int exit_code, const Arguments& parts) const {
    EXPECT_TRUE(is_refused(run, exit_code, parts));
    EXPECT_EQ(folder_.entries(), Arguments{"press.csv"});
  }

  TemporaryFolder folder_;
};

TEST_F(FitVerb, JsonIsOneObjectWithTheContractsKeys) {
  const ProgramRun run = fit({"--json"});
  expect_model(run);
  const auto object = nlohmann::json::parse(run.out);  // refuses any text after the object
  ASSERT_TRUE(object.is_object());
  EXPECT_EQ(object.at("method"), "trend+greedy");
  EXPECT_EQ(object.at("name"), "trend+greedy-20");
  EXPECT_EQ(object.at("kernel"), "cubic");
  EXPECT_EQ(object.at("weighting"), "jnd");
  EXPECT_EQ(object.at("centres"), 20);
  EXPECT_EQ(object.at("samples"), 1000);
  EXPECT_TRUE(object.at("samples_after_reduction").is_number_integer());
  EXPECT_GT(object.at("fit_seconds"), 0.0);
  EXPECT_GT(object.at("training_within_jnd"), 0.9);
  EXPECT_LE(object.at("training_within_jnd"), 1.0);
  ASSERT_EQ(object.at("recordings").size(), 1u);
  EXPECT_EQ(object.at("recordings")[0].at("name"), "press");
  EXPECT_TRUE(object.at("recordings")[0].at("surface_offset_m").is_number());
  EXPECT_TRUE(object.at("recordings")[0].at("force_zero_N").is_number());
}

TEST_F(FitVerb, TheSameCommandTwiceGivesTheSameBytes) {
  for (const ModelPlan& plan : all_plans()) {
    std::string texts[2];
    for (std::string& text : texts) {
      expect_model(fit({"--force"}, family_name(plan)));
      text = read_text(out());
    }
    EXPECT_EQ(texts[0], texts[1]) << family_name(plan);
  }
}

TEST_F(FitVerb, NamesItsMethodsOneToALine) {
  const ProgramRun run = run_palpate({"fit", "--list-methods"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.out,
            "direct\nvoxel\nrandom\nkdtree\ngreedy\ntrend\ntrend+direct\ntrend+voxel\ntrend+random\ntrend+kdtree\n"
            "trend+greedy\n");
}

TEST_F(FitVerb, SaysWhatWasSelectedAndWhatComesNext) {
  const ProgramRun force = fit({}, "greedy");
  expect_model(force);
  EXPECT_TRUE(has_parts(force.out, {"model", "greedy-20, fitted in", "samples", "1000, ", "relaxation times",
                                    "selected", "kernel, each feature divided by", "truncation", "training <= JND",
                                    "written", out(), "palpate replay --recording TEST.csv --model " + out()}));
  EXPECT_EQ(force.out.find("FEATURE"), std::string::npos) << "there is no dictionary of features";
  const ProgramRun trend = fit({"--force"}, "trend");
  expect_model(trend);
  EXPECT_TRUE(has_parts(trend.out, {"feature", "used", "model", "trend, fitted in"}));
  const std::string silicone = folder_.file("silicone.csv");
  must_run({"synth", "--material", "silicone", "--seconds", "20", "--out", silicone});
  EXPECT_TRUE(has_parts(fit({"--force", "--recording", silicone}, "trend").out,
                        {"relaxation times  fast ", " s, middle ", " s, slow "}));
}

TEST_F(FitVerb, WrongUsageListsTheKnownNames) {
  expect_refused(fit({}, "guess"), 2, {"direct, voxel, random, kdtree, greedy, trend, trend+direct"});
  expect_refused(fit({}, "greedy-0"), 2, {"greedy-0", "1 to 2000"});
  expect_refused(fit({"--centres", "30"}, "greedy-40"), 2, {"--centres", "30", "40"});
  expect_refused(fit({"--kernel", "gauss"}), 2, {"auto", "cubic, linear, thin-plate"});
  expect_refused(fit({"--centres", "0"}), 2, {"2000"});
  expect_refused(fit({"--centres", "100000"}), 2, {"2000"});
  expect_refused(fit({"--candidates", "some"}), 2, {"--candidates", "1", "all"});
  for (const char* grid : {"25x", "1x2x3x4", "axb", "9999999999x2"}) {
    expect_refused(fit({"--grid", grid}, "voxel"), 2, {"--grid", "25x11x11x11"});
  }
  expect_refused(run_palpate({"fit", "--method", "greedy", "--out", out()}), 2, {"--recording"});
}

TEST_F(FitVerb, FailuresAreOneErrorLine) {
  expect_refused(fit({"--scene", "marble"}), 2, {"marble", "silicone_block"});
  expect_refused(fit({"--grid", "25", "--features", "scene"}, "voxel"), 1, {"1", "4"});
  expect_refused(fit({"--grid", "2x2"}, "voxel"), 1, {"2 sizes", "4 features"});
  expect_refused(fit({"--grid", "1000x1000x1000x1000"}, "voxel"), 1, {"at most 1e7"});
  expect_refused(fit({"--recording", folder_.file("none.csv")}), 1, {"none.csv"});
}

TEST_F(FitVerb, AnExistingModelSurvivesWithoutForce) {
  folder_.with_file("model.json", "mine");
  const ProgramRun run = fit({});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_TRUE(test::has_parts(run.err, {"error: ", out(), "--force"}));
  EXPECT_EQ(read_text(out()), "mine");
  expect_model(fit({"--force"}));
}

// The direct fit takes seconds.
TEST_F(FitVerb, AnInterruptedRunLeavesNoFile) {
  ASSERT_TRUE(write_recording(recording(), example_recording(400000, 1000.0, 30e-6), {}, true).ok());
  // --foreground: otherwise `timeout` also signals its process group.
  const ProgramRun run = run_program({"timeout", "--foreground", "--preserve-status", "-s", "INT", "1", PALPATE_BINARY,
                                      "fit", "--recording", recording(), "--method", "direct", "--out", out()});
  EXPECT_EQ(run.exit_code, 130);
  EXPECT_EQ(run.err, "error: interrupted\n");
  EXPECT_EQ(folder_.entries(), Arguments{"press.csv"});
}

TEST_F(FitVerb, NeverWritesOverItsRecording) {
  const std::string recording = folder_.with_file("rec.csv", "mine\n");
  std::filesystem::create_hard_link(recording, folder_.file("same.csv"));
  std::filesystem::create_symlink(recording, folder_.file("link.csv"));
  for (const char* out : {"rec.csv", "same.csv", "link.csv"}) {
    EXPECT_TRUE(
        test::fails(1, {"fit", "--recording", recording, "--method", "greedy", "--out", folder_.file(out), "--force"},
                    {out, "the file to read from", "--out"}));
  }
  EXPECT_EQ(test::read_text(recording), "mine\n");
}

// A model for each recording of a folder, one table, and the same command does what is missing.
TEST_F(FitVerb, AFolderIsFittedFileByFileAndContinued) {
  const std::string out = folder_.file("models"), in = folder_.file("in");
  std::filesystem::create_directory(in);
  for (const char* name : {"a", "b", "c"})
    ASSERT_TRUE(write_recording(in + "/" + name + ".csv", example_recording(1000, 250.0), {}, false).ok());
  const Arguments command = {"fit", "--recording", in, "--method", "trend", "--out", out};
  EXPECT_TRUE(has_parts(must_run(command).out, {"3 of 3 recordings are done, 0 of them before", "models.csv"}));
  const std::string table = read_text(out + "/models.csv");
  EXPECT_TRUE(has_parts(table, {"recording,model,samples,", "\na,trend,1000,", "\nc,trend,1000,"}));
  const std::string before = read_text(out + "/a.json");

  std::filesystem::remove(out + "/b.json");
  EXPECT_TRUE(has_parts(must_run(command).out, {"3 of 3 recordings are done, 2 of them before"}));
  EXPECT_EQ(read_text(out + "/a.json"), before);
  EXPECT_EQ(read_text(out + "/models.csv"), table);

  EXPECT_TRUE(fails(1, {"fit", "--recording", in, "--method", "random", "--out", out},
                    {out + " exists, and this command has not made it; ", "--force"}));
  folder_.with_file("in/d.csv", "time_s,position_m,force_N\n");
  // The table of the others is written, and the error has a line for each recording without a model.
  const ProgramRun run = run_palpate(command);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_TRUE(has_parts(run.out, {"3 of 4 recordings are done, 3 of them before"}));
  EXPECT_TRUE(has_parts(
      run.err, {"error: 1 of 4 recordings are not done; correct what is said of them, then", "\n  " + in + "/d.csv"}));
  EXPECT_EQ(run.err.find("d.csv"), run.err.rfind("d.csv"));
  EXPECT_TRUE(has_parts(read_text(out + "/models.csv"), {"\nc,trend,1000,", "\nd,,,,,", "d.csv"}));
  std::filesystem::remove(in + "/d.csv");

  // With a file to write, the recordings of the folder are one training set.
  must_run({"fit", "--recording", in, "--method", "trend", "--out", this->out()});
  EXPECT_EQ(load_model(this->out()).value()->data().provenance.recordings, (Arguments{"a", "b", "c"}));
}

}  // namespace
}  // namespace palpate::test
