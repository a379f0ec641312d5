// Finding and opening a device. linked_device_test.cpp tests its threads.
#include "devices/link/device_link.h"
#include "devices/hid/hid_protocols.h"

#include <gtest/gtest.h>

#include "tests/support/fake_device_bus.h"

namespace palpate {
namespace {

using test::FakeDeviceBus;

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

}  // namespace
}  // namespace palpate
