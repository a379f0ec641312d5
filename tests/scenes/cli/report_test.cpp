// The program palpate report, from short recordings to the page.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "engine/recording/recording.h"
#include "tests/support/message_parts.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using test::run_palpate;

// All cases share one report, because making it takes long.
class ReportVerb : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryFolder;
    for (const int seed : {1, 2}) {
      test::must_run({"synth", "--material", "silicone", "--seed", std::to_string(seed), "--seconds", "4", "--rate",
                      "100", "--out", recording(seed)});
    }
    report_ = report({"--train", recording(1), "--test", recording(2), "--out", out()});
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  void SetUp() override { ASSERT_EQ(report_.exit_code, 0) << report_.err; }

  static std::string out() { return folder_->file("report"); }
  static std::string recording(int seed) { return folder_->file("r" + std::to_string(seed) + ".csv"); }
  static test::ProgramRun report(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"report", "--quick"});
    return run_palpate(arguments);
  }

  static Json json_of(const std::string& folder) { return Json::parse(test::read_text(folder + "/report.json")); }

  static test::TemporaryFolder* folder_;
  static test::ProgramRun report_;
};

test::TemporaryFolder* ReportVerb::folder_ = nullptr;
test::ProgramRun ReportVerb::report_;

TEST_F(ReportVerb, WritesTheWholeFolderAndNothingBesideIt) {
  EXPECT_EQ(report_.err, "");
  EXPECT_TRUE(test::has_parts(report_.out, {"model", "99 % error [JND]", "tick [ns]", "no force", "voxel", "kdtree",
                                            "recommended", "of the test is within one JND, a tick takes",
                                            "Confirm: palpate replay", "figures/speed_error.png, .svg", "index.html"}));
  EXPECT_LT(std::ranges::count(report_.out, '\n'), 24);
  EXPECT_EQ(folder_->entries(), (std::vector<std::string>{"r1.csv", "r2.csv", "report"}));
  const Json json = json_of(out());
  EXPECT_EQ(json["format"], "palpate-report");
  EXPECT_EQ(json["quick"], true);
  EXPECT_EQ(json["folds"], 0);
  EXPECT_EQ(json["relaxation_papers_times_s"].size(), 2u) << "two, fitted to the recordings";
  ASSERT_EQ(json["figures"].size(), 3u);
  for (const Json& figure : json["figures"]) {
    const std::string stem = out() + "/figures/" + figure.get<std::string>();
    EXPECT_GT(fs::file_size(stem + ".svg"), 1000u) << stem;
    EXPECT_GT(fs::file_size(stem + ".png"), 1000u) << stem;
  }
  for (const auto& [name, rows] : json["tables"].items()) {
    EXPECT_TRUE(fs::exists(out() + "/tables/" + name + ".csv")) << name;
  }
}

// One line of at most 25 words; the model that it names is in the folder, and gives the figures of its row.
TEST_F(ReportVerb, TheAnswerIsOneLineAndItsModelIsWritten) {
  const Json timings = json_of(out())["timings"];
  const std::string answer = timings["answer"];
  EXPECT_LE(std::ranges::count(answer, ' '), 24) << answer;
  const auto ran = run_palpate({"replay", "--recording", recording(2), "--model", out() + "/model.json", "--json"});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const Json model = Json::parse(ran.out)["models"][0];
  for (const Json& row : json_of(out())["tables"]["models"])
    if (row["model"] == timings["recommended"] && row["seeds"] == 1) {
      EXPECT_EQ(row["p99_error_over_jnd"], model["p99_error_over_jnd"]);
      EXPECT_EQ(row["contact_samples"], Json::parse(ran.out)["contact_samples"]) << "one definition of contact";
    }
}

TEST_F(ReportVerb, PageNeedsNothingElse) {
  std::string page = test::read_text(out() + "/index.html");
  EXPECT_LT(page.size(), 1000000u);
  EXPECT_EQ(page.rfind("<!DOCTYPE html>", 0), 0u);
  EXPECT_TRUE(test::has_parts(page, {"prefers-color-scheme: dark", "<svg viewBox"}));
  for (const auto& [begin, end] : {std::pair<std::string, std::string>{"<!--", "-->"}, {"<script", "</script>"}})
    for (std::size_t at; (at = page.find(begin)) != std::string::npos;)
      page.erase(at, page.find(end, at) + end.size() - at);
  for (const char* outside : {"http:", "https:", "<link", "<img", "@import", "src="}) {
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  }
  // Every reference is to an id of the page or to a file of the folder.
  std::map<std::string, int> ids;
  const std::regex id("\\bid=[\"']([^\"']+)[\"']");
  for (std::sregex_iterator it(page.begin(), page.end(), id), end; it != end; ++it) {
    if ((*it)[1].str().find("gnuplot_plot") == std::string::npos) ++ids[(*it)[1]];
  }
  const std::regex reference("href=[\"']([^\"']+)[\"']");
  for (std::sregex_iterator it(page.begin(), page.end(), reference), end; it != end; ++it) {
    const std::string target = (*it)[1];
    if (target[0] == '#') {
      EXPECT_EQ(ids[target.substr(1)] > 0, true) << target;
    } else {
      EXPECT_TRUE(fs::exists(out() + "/" + target)) << target << ": data one click away, in the folder itself";
    }
  }
}

TEST_F(ReportVerb, EveryFigureCanBeDrawnAgainFromItsFolder) {
  for (const char* name : {"speed_error", "worst_stretch", "error_by_force"}) {
    const std::string svg = out() + "/figures/" + name + ".svg";
    const std::string before = test::read_text(svg);
    fs::remove(svg);
    const auto drawn =
        test::run_program({"sh", "-c", "cd '" + out() + "/figures' && LC_ALL=C gnuplot -d " + name + ".gp"});
    EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
    EXPECT_TRUE(test::read_text(svg) == before) << name;
  }
}

TEST_F(ReportVerb, AFailureIsOneErrorAndLeavesNoFiles) {
  const std::string bad = folder_->with_file("bad.csv", "time_s,position_m\n0,0\n");
  const std::string copy = folder_->with_file("copy.csv", test::read_text(recording(1)));
  const auto before = folder_->entries();
  const std::string written = test::read_text(out() + "/report.json");
  struct Failure {
    std::vector<std::string> arguments;
    std::vector<std::string> parts;
  };
  const std::string other = folder_->file("other");
  for (const auto& [arguments, parts] :
       {Failure{{"--train", bad, "--out", other}, {"error: " + bad + ":1:"}},
        Failure{{"--train", recording(1), "--test", copy, "--out", other}, {"copy: ", "from 0 s", "r1 from 0 s"}},
        Failure{{"--out", out()}, {"error: ", out(), "--force"}}}) {
    const auto ran = report(arguments);
    EXPECT_EQ(ran.exit_code, 1);
    EXPECT_TRUE(test::has_parts(ran.err, parts));
  }
  EXPECT_EQ(run_palpate({"report"}).exit_code, 2);
  EXPECT_TRUE(test::fails(2, {"report", "--test", bad, "--out", other}, {"error: ", "--test", "--train", "; "}));
  EXPECT_EQ(folder_->entries(), before);
  EXPECT_EQ(test::read_text(out() + "/report.json"), written);
  fs::remove(bad);
  fs::remove(copy);
}

TEST_F(ReportVerb, TheSameRecordingsGiveTheSameFiguresButForTimes) {
  const std::string other = folder_->file("again");
  const auto again = report({"--train", recording(1), "--test", recording(2), "--out", other});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(json_of(out())["tables"], json_of(other)["tables"]);
  const std::string name = "/figures/error_by_force.svg";
  EXPECT_TRUE(test::read_text(out() + name) == test::read_text(other + name));
  fs::remove_all(other);
}

TEST_F(ReportVerb, CrossValidatesWithoutATest) {
  const std::string other = folder_->file("two folds");
  const auto ran = report({"--train", recording(1), recording(2), "--out", other});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const Json json = json_of(other);
  EXPECT_EQ(json["folds"], 2);
  EXPECT_TRUE(test::has_parts(json["command_line"], {" --out '" + other + "'"})) << "ready to copy";
  EXPECT_TRUE(test::has_parts(test::read_text(other + "/index.html"), {"2-fold cross-validation"}));
  // Both recordings were tested, so that the pooled samples include both.
  std::uint64_t contact = 0;
  for (const Json& recording : json["tables"]["recordings"])
    contact += recording["contact_samples"].get<std::uint64_t>();
  EXPECT_EQ(json["tables"]["models"][0]["contact_samples"], contact);
  fs::remove_all(other);
}

// Interrupted at once or during a fit, it leaves no folder, not even a hidden one.
TEST_F(ReportVerb, AnInterruptedRunLeavesNothing) {
  const test::TemporaryFolder empty;
  for (const char* after_s : {"0.1", "2"}) {
    // --foreground: otherwise `timeout` also signals its process group, and a second signal
    // ends the program at once.
    const auto ran = test::run_program({"timeout", "--foreground", "--preserve-status", "-s", "INT", after_s,
                                        PALPATE_BINARY, "report", "--quick", "--out", empty.file("report")});
    EXPECT_EQ(ran.exit_code, 130) << ran.err;
    EXPECT_TRUE(ran.err.empty() || ran.err == "error: interrupted\n") << ran.err;
    EXPECT_TRUE(empty.entries().empty()) << empty.entries().front();
  }
}

// Recomputes every number of the first screen from the forces of `palpate replay`, with a
// script that shares no code with the program.
TEST_F(ReportVerb, FirstScreenAgreesWithAnIndependentScript) {
  if (test::run_program({"python3", "-c", ""}).exit_code != 0) GTEST_SKIP() << "no python3 here";
  std::vector<std::string> check{"python3", std::string(PALPATE_SOURCE_DIR) + "/tests/scenes/report/check_report.py",
                                 out()};
  const Json json = json_of(out());
  std::vector<std::string> files;
  for (const Json& row : json["tables"]["models"]) {
    const std::string name = row["model"];
    if (name == "no force") continue;
    const std::string model = folder_->file("model.json");
    std::string given;
    for (int seed = 1; seed <= row["seeds"]; ++seed) {
      files.push_back(folder_->file(name + "_" + std::to_string(seed) + ".csv"));
      std::vector<std::string> fit{"fit", "--recording", recording(1), "--method", name, "--out", model, "--force"};
      if (row["seeds"] > 1) fit.insert(fit.end(), {"--seed", std::to_string(seed)});
      auto ran = run_palpate(fit);
      ASSERT_EQ(ran.exit_code, 0) << ran.err;
      ran =
          run_palpate({"replay", "--recording", recording(2), "--model", model, "--name", name, "--out", files.back()});
      ASSERT_EQ(ran.exit_code, 0) << ran.err;
      given += (given.empty() ? "" : ",") + files.back();
    }
    check.push_back(name + "=" + given);
    fs::remove(model);
  }
  const auto checked = test::run_program(check);
  EXPECT_EQ(checked.exit_code, 0) << checked.out << checked.err;
  for (const std::string& file : files) fs::remove(file);
}

}  // namespace
}  // namespace palpate
