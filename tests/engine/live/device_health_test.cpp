// Messages about the state of a device.
#include "engine/live/device_health.h"

#include <gtest/gtest.h>

#include "tests/support/message_parts.h"

namespace palpate {
namespace {

TEST(DeviceHealth, SaysHowToZero) {
  DeviceHealth health;
  EXPECT_EQ(zeroing_words(health), "");
  health.zeroing = Zeroing::needed;
  EXPECT_TRUE(test::has_parts(zeroing_words(health), {"rest position", "zeroing"}));
  health.zeroing = Zeroing::hold_still;
  health.zeroing_progress = 0.5F;
  EXPECT_TRUE(test::has_parts(zeroing_words(health), {"hold", "50 %"}));
  health.zeroing = Zeroing::done;
  EXPECT_EQ(zeroing_words(health), "");
}

TEST(DeviceHealth, PushesOnlyWhenAllIsWell) {
  DeviceHealth health;
  EXPECT_TRUE(health.may_push());
  health.zeroing = Zeroing::needed;
  EXPECT_FALSE(health.may_push());
  health.zeroing = Zeroing::hold_still;
  EXPECT_FALSE(health.may_push());
  health.zeroing = Zeroing::done;
  EXPECT_TRUE(health.may_push());
  health.faults = device_fault::kLate;
  EXPECT_FALSE(health.may_push());
}

}  // namespace
}  // namespace palpate
