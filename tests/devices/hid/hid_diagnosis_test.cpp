// Recognising devices, and the reason why one cannot be used.
#include "devices/hid/hid_protocols.h"
#include "devices/link/device_bus.h"

#include <gtest/gtest.h>

#include "tests/support/fake_device_bus.h"

namespace palpate {
namespace {

using test::FakeDeviceBus;
using test::found_board;
using test::found_space_mouse;

TEST(DeviceBus, KnowsDevicesByTheirIds) {
  EXPECT_EQ(hid_protocol_of(found_board()), &kOpenFfBoardProtocol);
  EXPECT_EQ(hid_protocol_of(found_space_mouse()), &kSpaceMouseProtocol);
  EXPECT_EQ(hid_protocol_of({"/dev/hidraw0", "", 0x256F, 0xC635, 1, 8}), &kSpaceMouseProtocol);
  EXPECT_EQ(hid_protocol_of({"/dev/hidraw0", "", 0x256F, 0xC635, 1, 2}), nullptr) << "its other usage";
  EXPECT_EQ(hid_protocol_of({"/dev/hidraw0", "Mouse", 0x046D, 0xC077, 1, 2}), nullptr);
}

TEST(DeviceBus, NamesDevicesAndWhyTheyCannotBeUsed) {
  FakeDeviceBus bus;
  HidDiagnosis diagnosis = diagnose(bus).at(0);
  EXPECT_EQ(diagnosis.use, "OpenFFBoard, one axis");
  EXPECT_EQ(diagnosis.problem, "");
  bus.refusals = 1;
  diagnosis = diagnose(bus).at(0);
  EXPECT_EQ(diagnosis.problem, "/dev/hidraw7: no permission");
  FakeDeviceBus mouse(found_space_mouse());
  EXPECT_EQ(diagnose(mouse).at(0).use, "SpaceMouse, input only: no force");
  FakeDeviceBus keyboard(DeviceNode{"/dev/hidraw0", "Keyboard", 1, 2, 1, 6});
  diagnosis = diagnose(keyboard).at(0);
  EXPECT_EQ(diagnosis.use, "not supported");
  EXPECT_EQ(diagnosis.problem, "");
  EXPECT_EQ(keyboard.opened, 0);
}

}  // namespace
}  // namespace palpate
