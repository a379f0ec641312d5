// The program palpate record, and the advice of its guide.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include "engine/recording/recording.h"
#include "scenes/cli/verbs.h"
#include "tests/support/bridge_session.h"
#include "tests/support/message_parts.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::run_palpate;

const std::string kBridge =
    "bridge:exec:python3 " + std::string(PALPATE_SOURCE_DIR) + "/assets/examples/bridge/bridge.py";

// A recording replayed at its recorded rate: a device that measures force and starts at once.
std::string replayed(const test::TemporaryFolder& folder) {
  const std::string path = folder.file("replayed.csv");
  EXPECT_EQ(run_palpate({"synth", "--material", "foam", "--seconds", "20", "--rate", "2000", "--out", path}).exit_code,
            0);
  return "replay:" + path;
}

TEST(Record, WritesMotionAndForceOfADeviceAndChecksThem) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("press.csv");
  const auto run = test::must_run({"record", "--device", kBridge, "--seconds", "3", "--out", path});
  EXPECT_EQ(run.out.rfind("recorded ", 0), 0u) << run.out;
  EXPECT_TRUE(test::has_parts(run.out, {"% of the contact samples within the JND"}));
  const auto recording = test::must(read_recording(path));
  EXPECT_GT(recording.rows.size(), 500u);
  for (const RecordingRow& row : recording.rows) {
    ASSERT_NEAR(row.force_N, 400.0 * std::max(0.0, row.position_m), 2e-6) << "the spring of the example";
  }
  const auto again = run_palpate({"record", "--device", kBridge, "--seconds", "1", "--out", path});
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_TRUE(test::has_parts(again.err, {"exists"})) << "after the device's note";
}

TEST(Record, ARunThatIsStoppedOrKilledLeavesWholeRows) {
  for (const auto& [signal, exit_code] : {std::pair{SIGINT, 0}, {SIGKILL, 128 + SIGKILL}}) {
    SCOPED_TRACE(signal);
    const test::TemporaryFolder folder;
    const std::string path = folder.file("press.csv");
    test::ChildProcess program({PALPATE_BINARY, "record", "--device", replayed(folder), "--out", path});
    const std::string part = path + ".part";
    const auto has_rows = [&] { return std::filesystem::exists(part) && std::filesystem::file_size(part) > 50'000; };
    ASSERT_TRUE(test::wait_for(has_rows, 120));
    EXPECT_EQ(program.end(signal), exit_code);
    EXPECT_EQ(std::filesystem::exists(path), exit_code == 0) << "no unfinished file under its name";
    EXPECT_GE(test::must(read_recording(exit_code == 0 ? path : part)).rows.size(), 1000u);
  }
}

TEST(Record, RefusesDevicesWithAReason) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(test::fails(1, {"record", "--device", "bridge:exec:false", "--out", folder.file("a.csv")},
                          {"error: ", "exit code", "1", "; "}));
  EXPECT_EQ(run_palpate({"record", "--device", "hand"}).exit_code, 2) << "no --out";
  EXPECT_EQ(run_palpate({"record", "--device", "hand", "--seconds", "0", "--out", "a.csv"}).exit_code, 2);
  EXPECT_EQ(run_palpate({"record", "--device", "hand", "--seconds", "nan", "--out", "a.csv"}).exit_code, 2);
}

TEST(DevicesTest, ADeviceShowsThatItsWatchdogStopsIt) {
  EXPECT_TRUE(test::has_parts(test::must_run({"devices", "--test", kBridge}).out,
                              {"watchdog    stopped", "heartbeat   stopped"}));
  EXPECT_EQ(run_palpate({"devices", "--test", "hand"}).exit_code, 2);
}

TEST(DevicesTest, RefusesADeviceThatDoesNotReportItsWatchdog) {
  const test::TemporaryFolder folder;
  const std::string peer = std::string(PALPATE_SOURCE_DIR) + "/tests/devices/bridge/peer.py";
  // A device reports by the flag 2 that its watchdog stopped it. This one does not.
  folder.with_file("mute.py", test::read_text(peer).insert(0, "").replace(
                                  test::read_text(peer).find("(2 if heard_s and silent else 0)"), 32, "0"));
  EXPECT_TRUE(test::fails(
      1, {"devices", "--test", "bridge:exec:python3 " + folder.file("mute.py") + " none 1 " + folder.file("log")},
      {"100 ms", "watchdog"}));
}

TEST(RecordGuide, GivesTheAdviceOfCheckOnce) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("press.csv.part");
  const CheckRequest request{{}, true};
  cli::RecordGuide guide(folder.file("press.csv"), request);
  EXPECT_EQ(guide.update(0.0), std::vector<std::string>{"next: touch the block, then press it slowly"});
  EXPECT_TRUE(guide.update(1.0).empty()) << "no check within two seconds";

  // Three slow presses without a hold.
  std::string text = "time_s,position_m,force_N\n";
  for (int i = 0; i < 15000; ++i) {
    const double position_m = 1.9e-3 + 2.1e-3 * std::sin(2.0 * std::numbers::pi * i / 5000.0);
    text += std::to_string(1e-3 * i) + "," + std::to_string(position_m) + "," +
            std::to_string(500.0 * std::max(0.0, position_m)) + "\n";
  }
  folder.with_file("press.csv.part", text);
  const std::vector<std::string> lines = guide.update(1e6);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_TRUE(test::has_parts(lines[0], {"record next: ", "above", "mm/s at ", " mm"}));
  EXPECT_TRUE(test::has_parts(lines[1], {"hold still at two or three depths"}));
  EXPECT_TRUE(test::has_parts(lines[2], {"small strokes"}));
  const auto file = test::must(check_recording_file(path, request));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(std::ranges::count(file.check.findings, lines[i], &Finding::advice), 1) << "the words of check";
  }
  EXPECT_TRUE(guide.update(2e6).empty()) << "nothing has changed";
}

}  // namespace
}  // namespace palpate
