// Valid and broken calibration files.
#include "devices/link/device_calibration.h"
#include "devices/hid/hid_protocols.h"

#include <gtest/gtest.h>

#include "tests/support/replaced.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

const std::string kAssets = std::string(PALPATE_SOURCE_DIR) + "/assets/devices";

std::string good() { return test::read_text(kAssets + "/openffboard.json"); }

std::string changed(const std::string& from, const std::string& to) { return test::replaced(good(), from, to); }

std::string complaint(const std::string& text) {
  const Result<DeviceCalibration> result = parse_calibration(text, "openffboard.json", kOpenFfBoardProtocol);
  return result ? "accepted" : result.error().message;
}

TEST(DeviceCalibration, ReadsEveryKindOfTheAssets) {
  for (const DeviceProtocol* protocol : kHidProtocols) {
    const Result<DeviceCalibration> calibration = read_calibration(kAssets, *protocol);
    ASSERT_TRUE(calibration.ok()) << calibration.error().message;
    EXPECT_EQ(calibration->protocol, protocol);
    EXPECT_GT(calibration->counts_per_metre, 0.0);
  }
  const Result<DeviceCalibration> board = read_calibration(kAssets, kOpenFfBoardProtocol);
  EXPECT_EQ(board->limits.largest_N, 5.0);
  EXPECT_EQ(board->limits.continuous_N, 2.0);
  EXPECT_EQ(board->limits.stale_after_s, 0.01);
}

TEST(DeviceCalibration, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(complaint("{").rfind("openffboard.json:1:2: syntax error", 0), 0u) << complaint("{");
  EXPECT_EQ(complaint("[]"), "openffboard.json:1:1: found a list of 0, expected an object with \"kind\"");
  EXPECT_EQ(complaint(changed("\"direction\": 1", "\"direction\": 0.5")),
            "openffboard.json:4:16: direction: found 0.5, expected 1 or -1");
  EXPECT_EQ(complaint(changed("\"peak_N\": 5", "\"peak_N\": 500")),
            "openffboard.json:9:13: peak_N: found 500, expected a number from 0.001 up to 100");
  EXPECT_EQ(complaint(changed("\"peak_N\": 5", "\"peak_N\": 1")),
            "openffboard.json:10:19: continuous_N: found 2, expected at most peak_N");
  EXPECT_EQ(complaint(changed("  \"ramp_s\": 0.5,\n", "")),
            "openffboard.json:1:1: ramp_s: found no such field, expected a number from 0.05 up to 10");
  EXPECT_EQ(complaint(changed("\"ramp_s\": 0.5", "\"ramp_s\": \"slow\"")),
            "openffboard.json:13:13: ramp_s: found \"slow\", expected a number from 0.05 up to 10");
  EXPECT_EQ(complaint(changed("\"openffboard\"", "\"joystick\"")),
            "openffboard.json:2:11: kind: found \"joystick\", expected one of openffboard");
  EXPECT_EQ(
      complaint(changed("\"ramp_s\": 0.5", "\"ramp_s\": 0.5, \"colour\": 3"))
          .rfind("openffboard.json:13:28: colour: found an unknown field, expected one of kind, counts_per_metre", 0),
      0u);
}

TEST(DeviceCalibration, SaysWhenTheFileIsNotThereOrOfAnotherKind) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(read_calibration(folder.path(), kOpenFfBoardProtocol).error().message,
            folder.file("openffboard.json") + ": cannot read the calibration; put the file there, see assets/devices/");
  folder.with_file("openffboard.json", test::read_text(kAssets + "/bridge.json"));
  const std::string of_another = read_calibration(folder.path(), kOpenFfBoardProtocol).error().message;
  EXPECT_NE(of_another.find("kind: found \"bridge\", expected one of openffboard"), std::string::npos) << of_another;
}

}  // namespace
}  // namespace palpate
