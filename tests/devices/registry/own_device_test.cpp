// The third file of a new device is the table of devices, with a new row. This test uses its own table.
#include "tests/support/own_device.h"
#include "tests/support/message_parts.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/live/live_tick.h"
#include "tests/support/live_doubles.h"

namespace palpate {
namespace {

using test::OwnDevice;

const std::vector<DeviceEntry>& entries() {
  static const std::vector<DeviceEntry> all = {
      {{"own:MM", "a device of three files", Holder::person, ""}, test::make_own_device}};
  return all;
}

TEST(OwnDevice, IsOpenedByItsNameAndRenderedOn) {
  auto device = open_device("own:4", {}, entries());
  ASSERT_TRUE(device.ok()) << device.error().message;
  ModelSlot<LiveModels> slot;
  LiveTick live(**device, slot);
  slot.publish(std::make_unique<LiveModels>(1, (*device)->sensor(), std::vector{test::spring(500.0)}));
  double largest_N = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const LoopSnapshot& snapshot = live.run(1e-3 * i, {});
    ASSERT_EQ(snapshot.faults & loop_fault::kStops, 0u) << i;
    largest_N = std::max(largest_N, static_cast<OwnDevice&>(**device).force_N());
  }
  EXPECT_NEAR(largest_N, 2.0, 0.02);
}

TEST(OwnDevice, HasTheErrorsOfAnyOther) {
  EXPECT_FALSE(open_device("own:no", {}, entries()).ok());
  const auto unknown = open_device("mouse", {}, entries());
  ASSERT_FALSE(unknown.ok());
  EXPECT_TRUE(test::has_parts(unknown.error().message, {"own:MM"}));
}

}  // namespace
}  // namespace palpate
