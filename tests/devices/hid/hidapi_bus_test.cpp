// The real bus without a device. tests/devices/emulated has an emulated one.
#include "devices/hid/hidapi_bus.h"

#include <gtest/gtest.h>

#include <cerrno>

#include "tests/support/message_parts.h"

namespace palpate {
namespace {

TEST(HidapiBus, SystemErrorsHaveAdvice) {
  EXPECT_TRUE(test::has_parts(open_error_words("/dev/hidraw0", EACCES),
                              {"/dev/hidraw0", "permission", "assets/udev/70-palpate.rules", "/etc/udev/rules.d"}));
  EXPECT_TRUE(test::has_parts(open_error_words("/dev/hidraw0", EBUSY), {"/dev/hidraw0", "in use", "; "}));
  EXPECT_TRUE(test::has_parts(open_error_words("/dev/hidraw0", ENOENT), {"/dev/hidraw0", "no node", "; "}));
  EXPECT_EQ(open_error_words("/dev/hidraw0", EIO), "/dev/hidraw0: Input/output error");
}

TEST(HidapiBus, TheRealOneWorksWithoutAnyDevice) {
  for (const DeviceNode& found : system_hid_bus().list()) EXPECT_FALSE(found.path.empty());
  EXPECT_FALSE(system_hid_bus().open({"/dev/no-such-node", "", 0, 0, 0, 0}).ok());
}

}  // namespace
}  // namespace palpate
