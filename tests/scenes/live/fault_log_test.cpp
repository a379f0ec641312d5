#include "scenes/live/fault_log.h"

#include <gtest/gtest.h>

#include "tests/support/message_parts.h"

namespace palpate {
namespace {

LoopSnapshot snapshot(double loop_time_s, std::uint32_t faults, std::uint64_t missed = 0) {
  LoopSnapshot result;
  result.loop_time_s = loop_time_s;
  result.faults = faults;
  result.missed_deadlines = missed;
  return result;
}

TEST(FaultLog, CountsFaultsWithinASecond) {
  FaultLog log;
  EXPECT_EQ(log.update(snapshot(10.0, loop_fault::kBadSample)), TickFaultLevel::alarm);
  EXPECT_EQ(log.update(snapshot(10.001, 0)), TickFaultLevel::none);
  EXPECT_EQ(log.update(snapshot(10.9, loop_fault::kBadSample)), TickFaultLevel::alarm);
  EXPECT_EQ(log.update(snapshot(11.8, loop_fault::kBadSample | loop_fault::kTimeNotLater)), TickFaultLevel::alarm);
  EXPECT_EQ(log.update(snapshot(13.0, loop_fault::kBadSample)), TickFaultLevel::alarm);
  ASSERT_EQ(log.events().size(), 3u);
  EXPECT_EQ(log.events()[0].loop_time_s, 10.0);
  EXPECT_EQ(log.events()[0].count, 3u);
  EXPECT_TRUE(test::has_parts(log.events()[0].text, {"not a number", "force"}));
  EXPECT_EQ(log.events()[1].count, 1u);
  EXPECT_EQ(log.events()[2].loop_time_s, 13.0);
}

TEST(FaultLog, TakesNormalRunningForNoFault) {
  FaultLog log;
  LoopSnapshot ramping = snapshot(1.0, loop_fault::kForceSlewed);
  ramping.limiter_flags = force_limit::kRamping;
  EXPECT_EQ(log.update(ramping), TickFaultLevel::none);
  EXPECT_EQ(log.update(snapshot(2.0, loop_fault::kForceSlewed)), TickFaultLevel::none);
  log.update_window(0, 0.049, 2.0);
  EXPECT_TRUE(log.events().empty());
}

TEST(FaultLog, CountsMissedDeadlinesEvenThoseOfLostSnapshots) {
  FaultLog log;
  EXPECT_EQ(log.update(snapshot(1.0, loop_fault::kDeadlineMissed, 2)), TickFaultLevel::late);
  EXPECT_EQ(log.update(snapshot(1.5, 0, 7)), TickFaultLevel::late);
  EXPECT_EQ(log.update(snapshot(1.6, 0, 7)), TickFaultLevel::none);
  ASSERT_EQ(log.events().size(), 1u);
  EXPECT_EQ(log.events()[0].count, 7u);
}

TEST(FaultLog, AStallIsOneEvent) {
  FaultLog log;
  for (int i = 0; i < 300; ++i) log.update_window(0, 0.051 + 0.016 * i, 10.0 + 0.016 * i);
  ASSERT_EQ(log.events().size(), 1u);
  EXPECT_EQ(log.events()[0].count, 1u);
  log.update_window(0, 0.001, 20.0);
  log.update_window(0, 0.2, 30.0);
  EXPECT_EQ(log.events().size(), 2u);
}

TEST(FaultLog, KeepsAlarmsUntilTheyAreAcknowledged) {
  FaultLog log;
  LoopSnapshot newest = snapshot(1.0, 0);
  EXPECT_TRUE(log.alarms(newest).empty());
  newest.faults_latched = loop_fault::kBadSample | loop_fault::kDeviceFault | loop_fault::kForceSlewed;
  newest.device_faults_latched = device_fault::kUnplugged;
  const std::vector<std::string> expected = {device_fault_words(device_fault::kUnplugged).front(),
                                             "the device gave a sample that is not a number: the force was set to 0"};
  EXPECT_EQ(log.alarms(newest), expected) << "the device first; a slewed force is no alarm";
  log.update_window(0, 0.2, 10.0);
  log.update_window(0, 0.0, 10.1);
  EXPECT_EQ(log.alarms(snapshot(20.0, 0)), std::vector<std::string>{"the haptics loop stood still for more than 50 ms"})
      << "the loop itself cannot latch that";
  log.acknowledge();
  EXPECT_TRUE(log.alarms(snapshot(20.0, 0)).empty());
}

}  // namespace
}  // namespace palpate
