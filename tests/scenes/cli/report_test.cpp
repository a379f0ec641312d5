// The program palpate report, from short recordings to the page.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "engine/recording/recording.h"
#include "scenes/hard/hard.h"
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
      EXPECT_EQ(row["contact_samples"], json_of(out())["tables"]["recordings"].back()["contact_samples"]);
    }
}

// A test that begins in a press continues the recording before it, as in replay, and errs less than from rest.
TEST_F(ReportVerb, ATestContinuesAnotherRecording) {
  const test::TemporaryFolder folder;
  Recording before = test::must(read_recording(recording(2))), tested = before;
  const auto half = tested.rows.begin() + static_cast<std::ptrdiff_t>(tested.rows.size() / 2);
  const auto pressed = std::ranges::max_element(tested.rows.begin(), half, {}, &RecordingRow::position_m);
  before.rows.resize(static_cast<std::size_t>(pressed - tested.rows.begin()));
  tested.rows.erase(tested.rows.begin(), pressed);
  for (const auto& [name, part] : {std::pair{"before.csv", before}, {"test.csv", tested}})
    ASSERT_TRUE(write_recording(folder.file(name), part, {}, false).ok());
  const std::string model = folder.file("model.json"), page = folder.file("page");
  test::must_run({"fit", "--recording", recording(1), "--method", "trend", "--out", model});
  std::vector<double> errors_N;
  for (const bool continues : {false, true}) {
    std::vector<std::string> asked{"--train", recording(1), "--test", folder.file("test.csv"),
                                   "--out",   page,         "--force"};
    std::vector<std::string> replayed{"replay", "--recording", folder.file("test.csv"), "--model", model, "--json"};
    for (auto* command : {&asked, &replayed})
      if (continues) command->insert(command->end(), {"--after", folder.file("before.csv")});
    const auto made = report(asked);
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const Json rows = json_of(page)["tables"]["models"], replay = Json::parse(test::must_run(replayed).out);
    const auto row = std::ranges::find(rows, "trend", [](const Json& one) { return one["model"]; });
    ASSERT_NE(row, rows.end());
    EXPECT_EQ((*row)["rms_error_N"], replay["models"][0]["rms_error_N"]);
    errors_N.push_back((*row)["rms_error_N"]);
  }
  EXPECT_LT(errors_N[1], 0.9 * errors_N[0]);
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

// Puts a collector of what the page `folder`/index.html says on its console, and the checks, into checked.html.
void add_checks(const std::string& folder) {
  std::string page = test::read_text(folder + "/index.html");
  page.insert(
      page.find("<head>") + 6,
      "<script>window.messages = []; addEventListener('error', event => messages.push(event.message));"
      "for (const kind of ['error', 'warn']) console[kind] = (...all) => messages.push(all.join(' '));</script>");
  page.insert(page.rfind("</body>"), "<script>addEventListener('load', () => setTimeout(() => {" +
                                         test::read_text(PALPATE_SOURCE_DIR "/tests/scenes/report/page_check.js") +
                                         "}, 300));</script>");
  std::ofstream(folder + "/checked.html") << page;
}

test::ProgramRun browse(const std::string& profile, std::vector<std::string> arguments) {
  const std::vector<std::string> common = {"chromium",      "--headless=new",          "--no-sandbox",
                                           "--disable-gpu", "--disable-dev-shm-usage", "--user-data-dir=" + profile};
  arguments.insert(arguments.begin(), common.begin(), common.end());
  return test::run_program(arguments);
}

// No message, nothing cut or on top of another, a zoom, a hover and a jump work; four A4 pages at most.
TEST_F(ReportVerb, ThePagesAreRightInABrowser) {
  test::TemporaryFolder folder;
  const std::string profile = folder.file("profile");
  if (browse(profile, {"--dump-dom", "about:blank"}).out.find("<html") == std::string::npos)
    GTEST_SKIP() << "no chromium that starts here";
  HardCase one;
  one.name = "a case";
  one.why = "what is hard";
  std::vector<HardRow> rows = {{one, std::vector<HardCell>(hard_methods().size())}};
  rows.front().cells.back().breaks = kBreaksStep;
  ASSERT_TRUE(write_hard_page(rows, {folder.file("hard"), false, "palpate hard", "palpate"}).ok());
  test::must_run({"paper", "--quick", "--out", folder.file("paper")});
  fs::copy(out(), folder.file("report"), fs::copy_options::recursive);
  std::string frames =
      "<!DOCTYPE html><title>waiting</title><script>addEventListener('message', event => "
      "{ document.title += '; ' + event.data; })</script>";
  for (const char* page : {"report", "paper", "hard"}) {
    add_checks(folder.file(page));
    for (const char* size : {"width=1280 height=800", "width=390 height=844"})
      frames += "<iframe src='" + std::string(page) + "/checked.html' " + size + "></iframe>";
  }
  const std::string all = folder.with_file("all.html", frames);
  for (const char* theme : {"preferredColorScheme=1", "preferredColorScheme=0"}) {
    const auto shown = browse(profile, {"--virtual-time-budget=9000", "--dump-dom",
                                        std::string("--blink-settings=") + theme, "file://" + all});
    const std::string said = shown.out.substr(0, shown.out.find("</title>"));
    for (const char* page : {"report", "paper", "hard"})
      for (const char* width : {" 1280: right", " 390: right"})
        EXPECT_NE(said.find(page + std::string(width)), std::string::npos) << page << width << ", " << theme << said;
  }
  const std::string printed = folder.file("printed.pdf");
  browse(profile, {"--print-to-pdf=" + printed, "file://" + folder.file("report/index.html")});
  const std::string pdf = test::read_text(printed);
  const std::size_t count = pdf.find("/Count ");
  ASSERT_NE(count, std::string::npos);
  EXPECT_LE(std::stoi(pdf.substr(count + 7)), 4);
}

// The four commands of the front page, on a table whose sensor reads 0.18 N in air and whose surface is at 12.4 mm, end
// with the figures of the table without both.
TEST_F(ReportVerb, AnOffsetOfForceAndSurfaceChangesNoFigure) {
  test::TemporaryFolder folder;
  std::map<std::string, Json> reports;
  for (const double share : {0.0, 1.0}) {
    std::vector<std::string> recordings;
    for (const int seed : {3, 4}) {
      const std::string name = std::to_string(seed) + (share > 0.0 ? "_off" : "");
      const std::string plain = folder.file("synth" + name + ".csv"), table = folder.file("rig" + name + ".csv");
      test::must_run({"synth", "--material", "silicone", "--seed", std::to_string(seed), "--seconds", "12", "--rate",
                      "500", "--out", plain});
      std::ofstream file(table);
      file.precision(9);
      file << "Time [ms];Position [mm];Force [N]\n";
      for (const RecordingRow& row : test::must(read_recording(plain)).rows)
        file << 1e3 * row.time_s << ";" << 1e3 * row.position_m + 12.4 * share << ";" << row.force_N + 0.18 * share
             << "\n";
      file.close();
      recordings.push_back(folder.file("rec" + name + ".csv"));
      test::must_run({"import", table, "--out", recordings.back()});
    }
    const std::string model = folder.file(share > 0.0 ? "m_off.json" : "m.json");
    test::must_run({"check", recordings[0]});
    test::must_run({"fit", "--recording", recordings[0], "--method", "trend", "--out", model});
    const std::string page = folder.file(share > 0.0 ? "report_off" : "report");
    const auto made = report({"--train", recordings[0], "--test", recordings[1], "--out", page});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const Json json = json_of(page);
    EXPECT_NEAR(json["force_zero_N"][0].get<double>(), 0.18 * share, 2e-3);
    const std::string answer = json["timings"]["answer"];
    EXPECT_EQ(answer.find("forces count from its free air, 0.18 N") != std::string::npos, share > 0.0) << answer;
    EXPECT_LE(std::ranges::count(answer, ' '), 25) << answer;
    for (const Json& row : json["tables"]["models"]) {
      const std::string name = row["model"];
      if (share == 0.0) reports[name] = row;
      if (share == 0.0 || !reports.contains(name)) continue;
      EXPECT_NEAR(row["within_jnd"].get<double>(), reports[name]["within_jnd"].get<double>(), 0.02) << name;
      if (name == "trend") {
        EXPECT_LT(row["untared_within_jnd"].get<double>(), 0.8);
      }
    }
    const Json replayed =
        Json::parse(test::must_run({"replay", "--recording", recordings[1], "--model", model, "--json"}).out);
    EXPECT_NEAR(replayed["force_zero_N"].get<double>(), 0.18 * share, 2e-3);
    const Json& model_of_replay = replayed["models"][0];  // its plain figures are as recorded
    EXPECT_EQ(model_of_replay["within_jnd"].get<double>() > 0.8, share == 0.0);
    const Json& zeroed = model_of_replay["force_zeroed"];
    EXPECT_GT((zeroed.is_null() ? model_of_replay : zeroed)["within_jnd"].get<double>(), 0.97);
  }
}

TEST_F(ReportVerb, AFolderIsReportedFileByFileAndContinued) {
  test::TemporaryFolder folder;
  fs::create_directory(folder.file("in"));
  for (const std::string seed : {"1", "2"})
    test::must_run({"synth", "--material", "silicone", "--seed", seed, "--seconds", "12", "--rate", "100", "--out",
                    folder.file("in/r" + seed + ".csv")});
  const std::string all = folder.file("all");
  const auto first = report({"--train", folder.file("in"), "--out", all});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_TRUE(test::has_parts(first.out, {"2 of 2 recordings are done, 0 of them before", "reports.csv"}));
  const std::string table = test::read_text(all + "/reports.csv");
  EXPECT_TRUE(test::has_parts(table, {"recording,recommended,no force,voxel,random-100,", "\nr1,", "\nr2,"}));
  fs::remove_all(all + "/r2");
  const auto again = report({"--train", folder.file("in"), "--out", all});
  EXPECT_TRUE(test::has_parts(again.out, {"2 of 2 recordings are done, 1 of them before"})) << again.err;
  EXPECT_TRUE(fs::exists(all + "/r2/index.html"));
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
  EXPECT_EQ(run_palpate({"report", "--out", "x", "--budget", "nan"}).exit_code, 2);
  EXPECT_EQ(run_palpate({"report", "--out", "x", "--scene", "nope"}).exit_code, 2);
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
