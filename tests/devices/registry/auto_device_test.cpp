// The cap of a SpaceMouse as a tool.
#include "devices/registry/device_registry.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "devices/firmware/wire.h"
#include "devices/hid/hidapi_bus.h"
#include "tests/support/fake_device_bus.h"

namespace palpate {
namespace {

DeviceCalibration calibration() {
  DeviceCalibration result;
  result.protocol = &kSpaceMouseProtocol;
  result.counts_per_metre = 17500.0;
  result.rest_position_m = -0.006;
  return result;
}

// A device with a SpaceMouse, whose reports the test makes in simulated time.
struct Moved {
  void report(int counts, double now_s) {
    std::uint8_t bytes[7] = {1};
    wire::write16(bytes + 5, static_cast<std::uint16_t>(counts));
    tool.report_arrived(bytes, sizeof bytes, now_s);
  }

  test::FakeDeviceBus bus{test::found_space_mouse()};
  AutoDevice tool{bus, calibration(), std::move(*open_first(bus, {&kSpaceMouseProtocol}))};
};

// A cap that moves evenly, reported every 16 ms: the tool moves at every tick of 1 ms, about equally far.
TEST(SpaceMouse, MovesAtEveryTickBetweenReports) {
  Moved moved;
  DeviceSample sample;
  double last_m = -0.006, largest_m = 0.0;
  int standing = 0;
  for (int ms = 0; ms <= 480; ++ms) {
    const double now_s = 1e-3 * ms;
    if (ms % 16 == 0) moved.report(300 * ms / 480, now_s);
    ASSERT_TRUE(moved.tool.MouseDevice::read(now_s, sample));
    if (ms > 150) {
      largest_m = std::max(largest_m, sample.tool.position_m - last_m);
      standing += sample.tool.position_m <= last_m ? 1 : 0;
    }
    last_m = sample.tool.position_m;
  }
  const double per_tick_m = 300.0 / 480.0 / 17500.0;
  EXPECT_LT(largest_m, 1.2 * per_tick_m) << "without the low-pass filter it would be 16 ticks' worth";
  EXPECT_EQ(standing, 0);
}

TEST(SpaceMouse, KeepsItsTargetWhileSilentAndIsAtZeroNearZero) {
  Moved moved;
  moved.report(200, 1.0);
  EXPECT_NEAR(moved.tool.target_m(), -0.006 + 200.0 / 17500.0, 1e-12);
  moved.report(5, 61.0);
  EXPECT_NEAR(moved.tool.target_m(), -0.006, 1e-12) << "not touched";
  EXPECT_FALSE(moved.tool.idle(80.0));
  moved.report(-5, 80.0);
  EXPECT_TRUE(moved.tool.idle(82.0)) << "near zero is no input";
  moved.report(5000, 83.0);
  EXPECT_NEAR(moved.tool.target_m(), -0.006, 1e-12) << "no deflection is that large";
}

// Reads `device` about every millisecond, in real time.
template <typename Done>
bool read_until(Device& device, DeviceSample& sample, Done done) {
  for (int i = 0; i < 5000 && !done(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    device.read(1.0 + 1e-3 * i, sample);
  }
  return done();
}

TEST(SpaceMouse, TakesOverFromTheHandInAuto) {
  test::FakeDeviceBus bus{test::found_space_mouse()};
  bus.report = {1, 0, 0, 0, 0, 0x2C, 0x01};  // the cap is pushed by 300 counts
  AutoDevice device(bus, calibration(), std::move(*open_first(bus, {&kSpaceMouseProtocol})));
  EXPECT_EQ(device.holder(), Holder::simulated);
  DeviceSample sample;
  for (int ms = 0; ms < 5; ++ms) device.read(1e-3 * ms, sample);
  EXPECT_TRUE(device.hand_is_exploring());
  ASSERT_TRUE(device.open().ok());
  EXPECT_TRUE(read_until(device, sample, [&] { return !device.hand_is_exploring(); }));
  EXPECT_TRUE(read_until(device, sample, [&] { return sample.tool.position_m > 5e-3; }));
  device.close();
  EXPECT_EQ(bus.writes, 0);
}

}  // namespace
}  // namespace palpate
