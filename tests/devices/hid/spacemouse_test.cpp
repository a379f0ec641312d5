// The cap of a SpaceMouse as a tool.
#include "devices/hid/spacemouse.h"
#include "devices/hid/hid_protocols.h"

#include <gtest/gtest.h>

#include <cmath>

#include "devices/registry/auto_device.h"
#include "tests/support/fake_device_bus.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

DeviceCalibration calibration() {
  DeviceCalibration result;
  result.protocol = &kSpaceMouseProtocol;
  result.counts_per_metre = 17500.0;
  result.rest_position_m = -0.006;
  return result;
}

void report(SpaceMouseAxis& axis, int counts, double now_s) {
  std::uint8_t bytes[7] = {1, 0, 0, 0, 0, 0, 0};
  bytes[5] = static_cast<std::uint8_t>(counts & 0xFF);
  bytes[6] = static_cast<std::uint8_t>((counts >> 8) & 0xFF);
  axis.report_arrived(bytes, sizeof bytes, now_s);
}

// A constant push, reported every 16 ms: the tool still moves at every tick of 1 ms.
TEST(SpaceMouse, MovesAtEveryTickBetweenReports) {
  SpaceMouseAxis axis(calibration());
  axis.connected(0.0);
  double last_m = axis.target_m(0.0);
  EXPECT_EQ(last_m, -0.006);
  double largest_m = 0.0;
  int standing = 0;
  for (int ms = 1; ms <= 480; ++ms) {
    const double now_s = 1e-3 * ms;
    if (ms % 16 == 0) report(axis, 300 * ms / 480, now_s);
    const double target_m = axis.target_m(now_s);
    if (ms > 100) {
      largest_m = std::max(largest_m, target_m - last_m);
      standing += target_m == last_m ? 1 : 0;
    }
    last_m = target_m;
  }
  const double per_tick_m = 300.0 / 480.0 / 17500.0;
  EXPECT_LT(largest_m, 1.2 * per_tick_m) << "without interpolation it would be 16 ticks' worth";
  EXPECT_EQ(standing, 0);
  EXPECT_NEAR(last_m, -0.006 + 300.0 / 17500.0, 17 * per_tick_m) << "one interval late";
}

TEST(SpaceMouse, RestsWhereItWasLeftAndNearZeroAtZero) {
  SpaceMouseAxis axis(calibration());
  axis.connected(0.0);
  report(axis, 200, 1.0);
  axis.target_m(1.0);
  EXPECT_NEAR(axis.target_m(1.02), -0.006 + 200.0 / 17500.0, 1e-12);
  EXPECT_NEAR(axis.target_m(60.0), -0.006 + 200.0 / 17500.0, 1e-12) << "it is silent while the cap is held";
  report(axis, 5, 61.0);
  axis.target_m(61.0);
  EXPECT_NEAR(axis.target_m(61.02), -0.006, 1e-12) << "not touched";
}

TEST(SpaceMouse, ReportsThatItIsUnplugged) {
  SpaceMouseAxis axis(calibration());
  axis.connected(0.0);
  report(axis, 200, 1.0);
  axis.target_m(1.0);
  EXPECT_EQ(axis.health(1.0).faults, 0u);
  EXPECT_TRUE(axis.health(1.0).may_push());
  axis.unplugged();
  EXPECT_EQ(axis.health(1.1).faults, device_fault::kUnplugged);
  axis.target_m(1.1);
  EXPECT_NEAR(axis.target_m(1.2), -0.006, 1e-12) << "lets go";
  const std::uint8_t bad[7] = {1, 0, 0, 0, 0, 0, 0x7F};
  axis.connected(2.0);
  axis.report_arrived(bad, sizeof bad, 2.0);
  EXPECT_EQ(axis.health(2.05).faults, device_fault::kCorrupt);
  EXPECT_EQ(axis.health(2.2).faults, 0u);
}

TEST(SpaceMouse, TakesOverFromTheHandInAuto) {
  test::FakeDeviceBus bus(test::found_space_mouse());
  bus.report = {1, 0, 0, 0, 0, 0x2C, 0x01};
  AutoDevice device;
  device.use(std::make_unique<SpaceMouse>(bus, calibration(), std::move(*open_first(bus, {&kSpaceMouseProtocol}))));
  DeviceSample sample;
  for (int ms = 0; ms < 5; ++ms) device.read(1e-3 * ms, sample);
  EXPECT_TRUE(device.hand_is_exploring());
  ASSERT_TRUE(device.open().ok());
  for (int i = 0; i < 5000 && device.hand_is_exploring(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    device.read(1.0 + 1e-3 * i, sample);
  }
  EXPECT_FALSE(device.hand_is_exploring());
  device.close();
}

TEST(SpaceMouse, IsADeviceWithoutForce) {
  test::FakeDeviceBus bus(test::found_space_mouse());
  bus.report = {1, 0, 0, 0, 0, 0x2C, 0x01};
  SpaceMouseDevice device(
      std::make_unique<SpaceMouse>(bus, calibration(), std::move(*open_first(bus, {&kSpaceMouseProtocol}))));
  EXPECT_EQ(device.holder(), Holder::simulated);
  EXPECT_TRUE(test::has_parts(device.note(), {"SpaceNavigator", "/dev/hidraw8"}));
  ASSERT_TRUE(device.open().ok());
  DeviceSample sample;
  for (int i = 0; i < 5000 && sample.tool.position_m < 5e-3; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    device.read(1.0 + 1e-3 * i, sample);
  }
  EXPECT_GT(sample.tool.position_m, 5e-3);
  EXPECT_EQ(bus.writes, 0);
}

}  // namespace
}  // namespace palpate
