// Which device is what, and why one cannot be used.
#include "devices/hid/hid_bus.h"
#include "devices/hid/hid_drivers.h"

#include <gtest/gtest.h>

#include "tests/support/fake_hid_bus.h"

namespace palpate {
namespace {

using test::FakeHidBus;
using test::found_board;
using test::found_space_mouse;

TEST(HidBus, KnowsDevicesByTheirIds) {
  EXPECT_EQ(matching_driver(found_board()), &kOpenFfBoardDriver);
  EXPECT_EQ(matching_driver(found_space_mouse()), &kSpaceMouseDriver);
  EXPECT_EQ(matching_driver({"/dev/hidraw0", "", 0x256F, 0xC635, 1, 8}), &kSpaceMouseDriver);
  EXPECT_EQ(matching_driver({"/dev/hidraw0", "", 0x256F, 0xC635, 1, 2}), nullptr) << "its other usage";
  EXPECT_EQ(matching_driver({"/dev/hidraw0", "Mouse", 0x046D, 0xC077, 1, 2}), nullptr);
}

TEST(HidBus, SaysWhatAPluggedInDeviceIsAndWhyItCannotBeUsed) {
  FakeHidBus bus;
  HidDiagnosis diagnosis = diagnose(bus).at(0);
  EXPECT_EQ(diagnosis.driver, &kOpenFfBoardDriver);
  EXPECT_EQ(diagnosis.use, "OpenFFBoard, one axis");
  EXPECT_EQ(diagnosis.problem, "");
  bus.refusals = 1;
  diagnosis = diagnose(bus).at(0);
  EXPECT_EQ(diagnosis.driver, nullptr);
  EXPECT_EQ(diagnosis.problem, "/dev/hidraw7: no permission");
  FakeHidBus mouse(found_space_mouse());
  EXPECT_EQ(diagnose(mouse).at(0).driver, &kSpaceMouseDriver);
  FakeHidBus keyboard(HidDeviceInfo{"/dev/hidraw0", "Keyboard", 1, 2, 1, 6});
  diagnosis = diagnose(keyboard).at(0);
  EXPECT_EQ(diagnosis.use, "none that this program uses");
  EXPECT_EQ(diagnosis.problem, "");
  EXPECT_EQ(keyboard.opened, 0);
}

}  // namespace
}  // namespace palpate
