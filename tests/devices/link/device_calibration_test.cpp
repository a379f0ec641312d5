// Valid and broken calibration files.
#include "devices/hid/hidapi_bus.h"
#include "devices/link/device_protocol.h"

#include <gtest/gtest.h>

#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

const std::string kAssets = std::string(PALPATE_SOURCE_DIR) + "/assets/devices";

std::string good() { return test::read_text(kAssets + "/openffboard.json"); }

// The message about the text without its folder.
std::string complaint(const std::string& text) {
  const test::TemporaryFolder folder;
  folder.with_file("openffboard.json", text);
  const Result<DeviceCalibration> result = read_calibration(folder.path(), kOpenFfBoardProtocol);
  return result ? "accepted" : result.error().message.substr(folder.path().size() + 1);
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

TEST(DeviceCalibration, ErrorsHaveThePlace) {
  EXPECT_EQ(complaint("{").rfind("openffboard.json:1:2: syntax error", 0), 0u) << complaint("{");
  EXPECT_TRUE(test::has_parts(complaint("[]"), {"openffboard.json:1:1:", "list of 0", "\"kind\""}));
  test::expect_messages(
      good(), complaint,
      {{R"("direction": 1)", R"("direction": 0.5)", {"openffboard.json:4:16:", "direction", "0.5", "1 or -1"}},
       {R"("peak_N": 5)", R"("peak_N": 500)", {"openffboard.json:9:13:", "peak_N", "500", "0.001", "100"}},
       {R"("peak_N": 5)", R"("peak_N": 1)", {"openffboard.json:10:19:", "continuous_N", "found 2,", "peak_N"}},
       {"  \"ramp_s\": 0.5,\n", "", {"openffboard.json:1:1:", "ramp_s", "0.05", "10"}},
       {R"("ramp_s": 0.5)", R"("ramp_s": "slow")", {"openffboard.json:13:13:", "ramp_s", "\"slow\"", "0.05", "10"}},
       {R"("openffboard")", R"("joystick")", {"openffboard.json:2:11:", "kind", "\"joystick\"", "openffboard"}},
       {R"("ramp_s": 0.5)", R"("ramp_s": 0.5, "colour": 3)", {"openffboard.json:13:28:", "colour", "kind"}}});
}

}  // namespace
}  // namespace palpate
