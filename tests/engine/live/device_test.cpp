// The state of a device and its messages.
#include "engine/live/device.h"

#include <gtest/gtest.h>

#include "tests/support/message_parts.h"

namespace palpate {
namespace {

TEST(DeviceHealth, PermitsAForceUnlessItHasAFaultOrNeedsZeroing) {
  struct Case {
    Zeroing zeroing;
    bool may_push;
    std::vector<std::string> advice;
  };
  const Case cases[] = {{Zeroing::not_needed, true, {}},
                        {Zeroing::needed, false, {"rest position", "zeroing"}},
                        {Zeroing::hold_still, false, {"hold", "50 %"}},
                        {Zeroing::done, true, {}}};
  DeviceHealth health;
  health.zeroing_progress = 0.5F;
  for (const Case& one : cases) {
    health.zeroing = one.zeroing;
    EXPECT_EQ(health.may_push(), one.may_push);
    EXPECT_EQ(zeroing_words(health).empty(), one.advice.empty());
    EXPECT_TRUE(test::has_parts(zeroing_words(health), one.advice));
  }
  health.faults = device_fault::kLate;
  EXPECT_FALSE(health.may_push());
}

}  // namespace
}  // namespace palpate
