// The real bus without a device. tests/devices/emulated has an emulated one.
#include "devices/hid/hidapi_bus.h"

#include <gtest/gtest.h>

#include <cerrno>

namespace palpate {
namespace {

TEST(HidapiBus, SaysWhatToDoAboutAnErrorOfTheSystem) {
  EXPECT_EQ(open_error_words("/dev/hidraw0", EACCES),
            "/dev/hidraw0: no permission; install assets/udev/70-palpate.rules in /etc/udev/rules.d, then plug the "
            "device in again");
  EXPECT_EQ(open_error_words("/dev/hidraw0", EBUSY), "/dev/hidraw0: in use by another program; close it");
  EXPECT_EQ(
      open_error_words("/dev/hidraw0", ENOENT).rfind("/dev/hidraw0: the device is plugged in but has no node; ", 0),
      0u);
  EXPECT_EQ(open_error_words("/dev/hidraw0", EIO), "/dev/hidraw0: Input/output error");
}

TEST(HidapiBus, TheRealOneWorksWithoutAnyDevice) {
  for (const DeviceNode& found : system_hid_bus().list()) EXPECT_FALSE(found.path.empty());
  EXPECT_FALSE(system_hid_bus().open({"/dev/no-such-node", "", 0, 0, 0, 0}).ok());
}

}  // namespace
}  // namespace palpate
