// Messages about the state of a device.
#include "engine/live/device_health.h"

#include <gtest/gtest.h>

#include "tests/support/message_parts.h"

namespace palpate {
namespace {

TEST(DeviceHealth, EveryFaultHasWords) {
  EXPECT_TRUE(device_fault_words(0).empty());
  for (std::uint32_t bit = 1; bit <= device_fault::kAll; bit *= 2) {
    const auto words = device_fault_words(bit);
    ASSERT_EQ(words.size(), 1u) << bit;
    EXPECT_NE(words[0].find(": "), std::string::npos) << "what happened, then what to do";
  }
  EXPECT_EQ(device_fault_words(device_fault::kAll).size(), 11u);
}

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
