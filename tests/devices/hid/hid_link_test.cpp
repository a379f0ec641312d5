// Finding and opening a device; its threads are in hid_device_test.
#include "devices/hid/hid_link.h"
#include "devices/hid/hid_drivers.h"

#include <gtest/gtest.h>

#include "tests/support/fake_hid_bus.h"

namespace palpate {
namespace {

using test::FakeHidBus;

TEST(HidLink, TriesAgainWhenItCannotBeOpenedAtFirst) {
  FakeHidBus bus;
  bus.refusals = 2;
  EXPECT_TRUE(open_first(bus, {&kOpenFfBoardDriver}).ok());
  EXPECT_EQ(bus.opened, 3);
  bus.refusals = 100;
  bool none_found = true;
  EXPECT_EQ(open_first(bus, {&kOpenFfBoardDriver}, &none_found).error().message, "/dev/hidraw7: no permission");
  EXPECT_FALSE(none_found);
  bus.plugged_in = false;
  EXPECT_EQ(open_first(bus, {&kOpenFfBoardDriver}, &none_found).error().message,
            "no device that the program knows is plugged in");
  EXPECT_TRUE(none_found);
}

TEST(HidLink, TakesOnlyTheKindsAskedFor) {
  FakeHidBus bus;
  EXPECT_EQ(open_first(bus, {&kOpenFfBoardDriver})->driver, &kOpenFfBoardDriver);
  EXPECT_FALSE(open_first(bus, {&kSpaceMouseDriver}).ok());
  EXPECT_EQ(bus.opened, 1) << "what was not asked for is left alone";
}

}  // namespace
}  // namespace palpate
