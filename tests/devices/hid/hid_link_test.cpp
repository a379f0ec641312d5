// Finding and opening a device; its threads are in hid_device_test.
#include "devices/hid/hid_drivers.h"
#include "devices/hid/hid_link.h"

#include <gtest/gtest.h>

#include "tests/support/fake_hid_bus.h"

namespace palpate {
namespace {

using test::FakeHidBus;

TEST(HidLink, TriesAgainWhenItCannotBeOpenedAtFirst) {
  FakeHidBus bus;
  bus.refusals = 2;
  EXPECT_TRUE(open_first(bus, {&kPaddleDriver}).ok());
  EXPECT_EQ(bus.opened, 3);
  bus.refusals = 100;
  bool none_found = true;
  EXPECT_EQ(open_first(bus, {&kPaddleDriver}, &none_found).error().message, "/dev/hidraw7: no permission");
  EXPECT_FALSE(none_found);
  bus.plugged_in = false;
  EXPECT_EQ(open_first(bus, {&kPaddleDriver}, &none_found).error().message,
            "no device that the program knows is plugged in");
  EXPECT_TRUE(none_found);
}

// Opened and identified, but of a driver that was not asked for.
TEST(HidLink, TakesOnlyTheKindsAskedFor) {
  FakeHidBus bus;
  bus.report = test::Report(64, 0);
  EXPECT_EQ(open_first(bus, {&kPolhemDriver})->driver, &kPolhemDriver);
  EXPECT_FALSE(open_first(bus, {&kPaddleDriver}).ok());
  EXPECT_FALSE(open_first(bus, {&kSpaceMouseDriver}).ok());
}

}  // namespace
}  // namespace palpate
