// Finding and opening a device; a device with its threads, in real time, on a fake bus.
#include "devices/link/device_link.h"
#include "devices/hid/hidapi_bus.h"

#include <gtest/gtest.h>

#include "engine/live/haptics_loop.h"
#include "tests/support/fake_device_bus.h"
#include "tests/support/hid_ticks.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

using test::FakeDeviceBus;
using test::tick_until;

TEST(DeviceLink, TriesAgainWhenItCannotBeOpenedAtFirst) {
  FakeDeviceBus bus;
  bus.refusals = 2;
  EXPECT_TRUE(open_first(bus, {&kOpenFfBoardProtocol}).ok());
  EXPECT_EQ(bus.opened, 3);
  bus.refusals = 100;
  EXPECT_EQ(open_first(bus, {&kOpenFfBoardProtocol}).error().message, "/dev/hidraw7: no permission");
  bus.plugged_in = false;
  EXPECT_EQ(open_first(bus, {&kOpenFfBoardProtocol})->connection, nullptr);
}

TEST(DeviceLink, TakesOnlyTheKindsAskedFor) {
  FakeDeviceBus bus;
  EXPECT_EQ(open_first(bus, {&kOpenFfBoardProtocol})->protocol, &kOpenFfBoardProtocol);
  EXPECT_EQ(open_first(bus, {&kSpaceMouseProtocol})->connection, nullptr);
  EXPECT_EQ(bus.opened, 1) << "what was not asked for is left alone";
}

std::unique_ptr<LinkedDevice> open_board(FakeDeviceBus& bus) {
  const DeviceCalibration calibration = test::patient(test::example_calibration(&kOpenFfBoardProtocol));
  Result<OpenedDevice> opened = open_first(bus, {&kOpenFfBoardProtocol});
  EXPECT_TRUE(opened.ok());
  auto device = std::make_unique<LinkedDevice>(bus, calibration, std::move(*opened));
  EXPECT_TRUE(device->open().ok());
  return device;
}

bool zeroed(const DeviceHealth& health) { return health.zeroing == Zeroing::done && health.faults == 0; }

TEST(LinkedDevice, PushesAfterZeroingAndLetsGoWhenClosed) {
  FakeDeviceBus bus;
  auto device = open_board(bus);
  EXPECT_TRUE(test::has_parts(device->note(), {"OpenFFBoard", "FFBoard", "/dev/hidraw7"}));
  EXPECT_TRUE(tick_until(*device, 1.0, [&](const DeviceHealth& health) {
    return health.faults == 0 && health.zeroing == Zeroing::needed;
  }));
  EXPECT_EQ(bus.motor_units(), 0.0) << "not zeroed";
  device->start_zeroing();
  ASSERT_TRUE(tick_until(*device, 0.0, zeroed));
  EXPECT_TRUE(tick_until(*device, 1.0, [&](const DeviceHealth&) { return bus.motor_units() == -3333.0; }));
  device->close();
  EXPECT_EQ(bus.motor_units(), 0.0);
}

TEST(LinkedDevice, ComesBackAfterItWasPluggedInAgain) {
  FakeDeviceBus bus;
  auto device = open_board(bus);
  device->start_zeroing();
  ASSERT_TRUE(tick_until(*device, 0.0, zeroed));
  bus.plugged_in = false;
  EXPECT_TRUE(tick_until(*device, 1.0, [](const DeviceHealth& health) {
    return (health.faults & device_fault::kUnplugged) != 0 && !health.may_push();
  }));
  bus.plugged_in = true;
  EXPECT_TRUE(tick_until(*device, 0.0, [&](const DeviceHealth& health) {
    return bus.opened == 2 && health.faults == device_fault::kUnplugged && health.zeroing == Zeroing::needed;
  })) << "it says why it has to be zeroed";
  device->start_zeroing();
  EXPECT_TRUE(tick_until(*device, 0.0, zeroed));
}

TEST(LinkedDevice, ADeviceThatBlocksOnEveryWriteDoesNotHoldTheTickUp) {
  FakeDeviceBus bus;
  bus.write_ms = 3;  // with two reports for each command, 160 positions a second
  auto device = open_board(bus);
  LoopSettings settings;
  settings.realtime = false;
  HapticsLoop loop(*device, settings);
  ASSERT_TRUE(loop.start().ok());
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  loop.stop();
  EXPECT_GT(bus.writes, 0);
  EXPECT_LT(bus.writes, static_cast<int>(loop.statistics().ticks)) << "only the newest command is written";
}

TEST(LinkedDevice, OneThatSendsFewerThanOneHundredPositionsASecondGetsNoForce) {
  FakeDeviceBus bus;
  bus.write_ms = 10;
  auto device = open_board(bus);
  EXPECT_TRUE(tick_until(*device, 1.0, [](const DeviceHealth& health) {
    return (health.faults & device_fault::kSlow) != 0 && !health.may_push();
  }));
  EXPECT_EQ(bus.motor_units(), 0.0);
}

}  // namespace
}  // namespace palpate
