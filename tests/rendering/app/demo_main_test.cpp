// The program palpate-demo: exit codes and output.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"

namespace palpate {
namespace {

using test::ProgramRun;
using test::run_program;
using test::TemporaryFolder;

ProgramRun demo(std::vector<std::string> arguments, const std::vector<std::string>& environment = {}) {
  arguments.insert(arguments.begin(), PALPATE_DEMO_BINARY);
  return run_program(arguments, environment);
}

// Expects one line on stderr and no other output.
void expect_error(const ProgramRun& run, const std::string& words) {
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(run.err.rfind("error: ", 0), 0u) << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
}

class DemoMain : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_FALSE(test::virtual_display().empty()) << "Xvfb does not start; apt-get install xvfb";
  }
  TemporaryFolder folder_;
};

TEST_F(DemoMain, WithoutADisplayItSaysSo) {
  expect_error(demo({}, {"DISPLAY=", "WAYLAND_DISPLAY="}), "no display");
  expect_error(demo({}, {"DISPLAY=:4711", "WAYLAND_DISPLAY="}), "no display");
}

TEST_F(DemoMain, WithoutOpenGl33ItSaysSo) {
  expect_error(demo({"--seconds", "1"}, {"MESA_GL_VERSION_OVERRIDE=2.1"}), "OpenGL 3.3");
}

TEST_F(DemoMain, UnknownScenesModelsAndDevicesAreNamed) {
  expect_error(demo({"--scene", "marble"}), "marble");
  expect_error(demo({"--model", "magic"}), "magic");
  expect_error(demo({"--model", folder_.file("none.json")}), "none.json");
  expect_error(demo({"--device", "wand"}), "wand");
}

// The X server ends while models are fitted and after that, with a block, a game or a study in the window.
TEST_F(DemoMain, WhenTheDisplayGoesAwayTheProgramSavesItsResultsAndSaysSo) {
  struct Case {
    std::vector<std::string> arguments;
    int after_s;
  };
  for (const auto& [arguments, after_s] : {Case{{}, 3},
                                           {{"--scene", "silicone_block", "--kiosk"}, 5},
                                           {{"--scene", "jnd_study", "--device", "hand"}, 3}}) {
    SCOPED_TRACE(arguments.empty() ? "" : arguments.back());
    test::OwnDisplay display;
    ASSERT_FALSE(display.name().empty());
    const std::string stats = folder_.file("stats.json");
    std::vector<std::string> all = {"--stats", stats, "--force", "--seconds", "60"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    std::filesystem::remove(stats);
    std::thread server_ends([&display, seconds = after_s] {
      std::this_thread::sleep_for(std::chrono::seconds(seconds));
      display.end();
    });
    const ProgramRun run = demo(all, {"DISPLAY=" + display.name(), "WAYLAND_DISPLAY="});
    server_ends.join();
    expect_error(run, "the display is gone");
    if (arguments.empty() || arguments.back() == "--kiosk") {
      EXPECT_EQ(nlohmann::json::parse(std::ifstream(stats)).count("haptics"), 1u);
    }
  }
}

// The game and the desktop are doubles.
TEST_F(DemoMain, TheExhibitIsStartedThreeTimesWithoutBlanking) {
  for (const auto& [name, line] : {std::pair("palpate-demo", "echo game $*; kill -SEGV $$"),
                                   std::pair("gnome-session-inhibit", "echo inhibit $2; shift 2; exec \"$@\"")})
    std::filesystem::permissions(folder_.with_file(name, std::string("#!/bin/sh\n") + line),
                                 std::filesystem::perms(0755));
  const ProgramRun run = run_program({PALPATE_SOURCE_DIR "/assets/package/palpate-exhibit", "--scene", "foam_block"},
                                     {"PATH=" + folder_.path() + ":/usr/bin:/bin", "XDG_DATA_HOME=" + folder_.path()});
  EXPECT_EQ(run.exit_code, 1);
  const std::string inhibit = "inhibit idle:suspend\n", game = "game --kiosk --scene foam_block\n";
  EXPECT_EQ(run.out, inhibit + inhibit + game + game + game);
  EXPECT_NE(test::read_text(folder_.file("palpate/exhibit.log")).find("(3 of 3)"), std::string::npos);
}

TEST_F(DemoMain, WrongUsageIsExitCode2) {
  EXPECT_EQ(demo({"--sceen", "skin"}).exit_code, 2);
  EXPECT_EQ(demo({"--seconds", "soon"}).exit_code, 2);
  EXPECT_EQ(demo({"--seconds", "nan"}).exit_code, 2);
  EXPECT_EQ(demo({"--help"}).exit_code, 0);
}

TEST_F(DemoMain, RunsForItsSecondsAndWritesStatsAndPicture) {
  const std::string stats = folder_.file("stats.json");
  const std::string picture = folder_.file("window.png");
  const ProgramRun run = demo({"--seconds", "3", "--model", "random", "--stats", stats, "--screenshot", picture});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  std::ifstream file(stats);
  const nlohmann::json json = nlohmann::json::parse(file);
  EXPECT_GT(json.at("haptics").at("ticks"), 500);
  for (const char* key : {"missed_deadlines", "lateness_us", "tick_us", "scheduling"})
    EXPECT_TRUE(json["haptics"].contains(key));
  for (const char* key : {"p50", "p99", "p99_9", "max"}) {
    EXPECT_TRUE(json["haptics"]["lateness_us"].contains(key));
    EXPECT_TRUE(json["haptics"]["tick_us"].contains(key));
  }
  EXPECT_GT(json.at("graphics").at("frames"), 0);
  for (const char* key : {"p50", "p99", "max"}) EXPECT_TRUE(json["graphics"]["frame_ms"].contains(key));
  EXPECT_TRUE(json.at("models").is_array());
  for (const auto& model : json["models"]) {
    for (const char* key : {"name", "within_jnd", "p99_error_over_jnd", "tick_ns"}) EXPECT_TRUE(model.contains(key));
  }
  EXPECT_TRUE(json.at("faults").is_array());
  std::ifstream png(picture, std::ios::binary);
  const std::string head{std::istreambuf_iterator<char>(png), {}};
  EXPECT_EQ(head.substr(1, 3), "PNG");

  expect_error(demo({"--seconds", "1", "--stats", stats}), "--force");
}

}  // namespace
}  // namespace palpate
