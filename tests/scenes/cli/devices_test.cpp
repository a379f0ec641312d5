// What palpate devices says about the devices that are plugged in.
#include <gtest/gtest.h>

#include "scenes/cli/verbs.h"
#include "tests/support/fake_device_bus.h"
#include "tests/support/message_parts.h"

namespace palpate::cli {
namespace {

TEST(DevicesVerb, SaysWhyADeviceCannotBeOpenedAndHowToFixIt) {
  test::FakeDeviceBus bus;
  bus.refusals = 1;
  const std::string refused = plugged_in_text(bus, "/share");
  EXPECT_TRUE(test::has_parts(
      refused, {"/dev/hidraw7  1209:ffb0  FFBoard: OpenFFBoard", "cannot be used: /dev/hidraw7: no permission\n",
                "sudo cp /share/udev/70-palpate.rules /etc/udev/rules.d/"}));
  const std::string opened = plugged_in_text(bus, "/share");
  EXPECT_EQ(opened.find("cannot be used"), std::string::npos) << opened;
  EXPECT_EQ(opened.find("udev"), std::string::npos) << opened;
}

TEST(DevicesVerb, ListsADeviceWithoutSupportAndNeverOpensIt) {
  test::FakeDeviceBus keyboard(DeviceNode{"/dev/hidraw0", "Keyboard", 1, 2, 1, 6});
  keyboard.refusals = 1;
  EXPECT_EQ(plugged_in_text(keyboard, "/share"),
            "\nPLUGGED IN (hidraw)\n  /dev/hidraw0  0001:0002  Keyboard: not supported\n");
  EXPECT_EQ(keyboard.opened, 0);
}

TEST(DevicesVerb, SaysThatASpaceMouseHasNoForce) {
  test::FakeDeviceBus mouse(test::found_space_mouse());
  EXPECT_TRUE(test::has_parts(plugged_in_text(mouse, "/share"), {"SpaceNavigator: SpaceMouse", "no force"}));
}

TEST(DevicesVerb, SaysThatNothingIsPluggedIn) {
  test::FakeDeviceBus none;
  none.plugged_in = false;
  EXPECT_TRUE(test::has_parts(plugged_in_text(none, "/share"), {"none; ", "plugged in"}));
}

}  // namespace
}  // namespace palpate::cli
