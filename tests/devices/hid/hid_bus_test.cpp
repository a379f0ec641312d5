// Which device is what, and why one cannot be used.
#include "devices/hid/hid_drivers.h"
#include "devices/hid/hid_bus.h"

#include <gtest/gtest.h>

#include "tests/support/fake_hid_bus.h"

namespace palpate {
namespace {

using test::FakeHidBus;
using test::found_space_mouse;
using test::found_teensy;
using test::Report;

using Kinds = std::vector<const HidDriver*>;

TEST(HidBus, KnowsDevicesByTheirIds) {
  EXPECT_EQ(matching_drivers(found_teensy()), (Kinds{&kPaddleDriver, &kPolhemDriver}));
  HidDeviceInfo console = found_teensy();
  console.usage_page = 0xFFC9;
  EXPECT_EQ(matching_drivers(console), Kinds{});
  EXPECT_EQ(matching_drivers({"/dev/hidraw0", "", 0x1209, 0xFFB0, 0xFF00, 1}), Kinds{&kOpenFfBoardDriver});
  EXPECT_EQ(matching_drivers(found_space_mouse()), Kinds{&kSpaceMouseDriver});
  EXPECT_EQ(matching_drivers({"/dev/hidraw0", "", 0x256F, 0xC635, 1, 8}), Kinds{&kSpaceMouseDriver});
  EXPECT_EQ(matching_drivers({"/dev/hidraw0", "Mouse", 0x046D, 0xC077, 1, 2}), Kinds{});
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
  bus.report = Report(64, 0);
  EXPECT_EQ(diagnose(bus).at(0).driver, &kPolhemDriver);
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
  EXPECT_EQ(
      diagnose(bus).at(0).problem,
      "/dev/hidraw7: sends no reports; is its firmware running? reset it or install devices/firmware/paddle");
  Report newer(64, 0);
  paddle::encode(paddle::FromDevice{}, newer.data());
  newer[1] = 2;
  EXPECT_EQ(problem_of(newer),
            "/dev/hidraw7: wrong firmware: speaks version 2 of the paddle protocol, expected 1; "
            "install devices/firmware/paddle");
  EXPECT_EQ(problem_of(Report(32, 7)),
            "/dev/hidraw7: wrong report size: found 32 bytes, expected 64; its firmware is "
            "another one, install devices/firmware/paddle");
  EXPECT_EQ(problem_of(Report(64, 7)),
            "/dev/hidraw7: its reports are none that this program knows; install devices/firmware/paddle");
}

}  // namespace
}  // namespace palpate
