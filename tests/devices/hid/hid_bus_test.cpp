// Which device is what, and why one cannot be used.
#include "devices/hid/hid_bus.h"
#include "devices/hid/hid_drivers.h"

#include <gtest/gtest.h>

#include "tests/support/fake_hid_bus.h"

namespace palpate {
namespace {

using test::FakeHidBus;
using test::found_space_mouse;
using test::found_teensy;
using test::Report;

TEST(HidBus, KnowsDevicesByTheirIds) {
  EXPECT_EQ(matching_driver(found_teensy()), &kPaddleDriver);
  HidDeviceInfo console = found_teensy();
  console.usage_page = 0xFFC9;
  EXPECT_EQ(matching_driver(console), nullptr);
  EXPECT_EQ(matching_driver({"/dev/hidraw0", "", 0x1209, 0xFFB0, 0xFF00, 1}), &kOpenFfBoardDriver);
  EXPECT_EQ(matching_driver(found_space_mouse()), &kSpaceMouseDriver);
  EXPECT_EQ(matching_driver({"/dev/hidraw0", "", 0x256F, 0xC635, 1, 8}), &kSpaceMouseDriver);
  EXPECT_EQ(matching_driver({"/dev/hidraw0", "Mouse", 0x046D, 0xC077, 1, 2}), nullptr);
}

std::string problem_of(const Report& report) {
  FakeHidBus bus;
  bus.report = report;
  return diagnose(bus).at(0).problem;
}

TEST(HidBus, SaysWhatAPluggedInDeviceIs) {
  FakeHidBus bus;
  HidDiagnosis diagnosis = diagnose(bus).at(0);
  EXPECT_EQ(diagnosis.driver, &kPaddleDriver);
  EXPECT_EQ(diagnosis.use, "haptic paddle");
  EXPECT_EQ(diagnosis.problem, "");
  FakeHidBus mouse(found_space_mouse());
  mouse.silent = true;
  EXPECT_EQ(diagnose(mouse).at(0).driver, &kSpaceMouseDriver) << "it is silent at rest";
  FakeHidBus keyboard(HidDeviceInfo{"/dev/hidraw0", "Keyboard", 1, 2, 1, 6});
  diagnosis = diagnose(keyboard).at(0);
  EXPECT_EQ(diagnosis.use, "none that this program uses");
  EXPECT_EQ(diagnosis.problem, "");
  EXPECT_EQ(keyboard.opened, 0);
}

TEST(HidBus, SaysWhyADeviceCannotBeUsed) {
  FakeHidBus bus;
  bus.refusals = 1;
  EXPECT_EQ(diagnose(bus).at(0).problem, "/dev/hidraw7: no permission");
  bus.silent = true;
  EXPECT_EQ(diagnose(bus).at(0).problem,
            "/dev/hidraw7: sends no reports; is its firmware running? reset it, or if it is a haptic paddle, "
            "install devices/firmware/paddle (it replaces what is on the board)");
  Report newer(64, 0);
  paddle::encode(paddle::FromDevice{}, newer.data());
  newer[1] = 2;
  EXPECT_EQ(problem_of(newer),
            "/dev/hidraw7: wrong firmware: speaks version 2 of the paddle protocol, expected 1; "
            "if it is a haptic paddle, install devices/firmware/paddle (it replaces what is on the board)");
  for (const std::size_t bytes : {32u, 64u}) {
    EXPECT_EQ(problem_of(Report(bytes, 7)),
              "/dev/hidraw7: its reports are none that this program knows; "
              "if it is a haptic paddle, install devices/firmware/paddle (it replaces what is on the board)");
  }
}

}  // namespace
}  // namespace palpate
