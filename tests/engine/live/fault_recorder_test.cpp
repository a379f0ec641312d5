// What is kept of a fault.
#include "engine/live/fault_recorder.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/support/rt_guard.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

FaultTick tick_at(int index) {
  FaultTick tick;
  tick.loop_time_s = 1e-3 * index;
  tick.rendered_N = index;
  return tick;
}

TEST(FaultRecorder, KeepsTheLastSecondAroundAFault) {
  FaultRecorder recorder;
  for (int i = 0; i < 5000; ++i) recorder.add(tick_at(i), i >= 4000 && i < 4050);
  const auto ticks = recorder.read();
  ASSERT_TRUE(ticks.has_value());
  ASSERT_EQ(ticks->size(), FaultRecorder::kTicks);
  EXPECT_EQ(ticks->back().rendered_N, 4100.0) << "until the force was gone";
  EXPECT_EQ(ticks->front().rendered_N, 3101.0);
  EXPECT_FALSE(recorder.read().has_value());
}

TEST(FaultRecorder, KeepsTheFirstFaultUntilItIsTaken) {
  FaultRecorder recorder;
  for (int i = 0; i < 3000; ++i) recorder.add(tick_at(i), i == 500 || i == 2000);
  EXPECT_EQ(recorder.dropped(), 1u);
  const auto ticks = recorder.read();
  ASSERT_TRUE(ticks.has_value());
  EXPECT_EQ(ticks->size(), 601u) << "the loop had not run for a second";
  for (int i = 3000; i < 4200; ++i) recorder.add(tick_at(i), i == 4000);
  ASSERT_TRUE(recorder.read().has_value());
}

TEST(FaultRecorder, HandsOverAFaultAtTheEnd) {
  FaultRecorder recorder;
  for (int i = 0; i < 10; ++i) recorder.add(tick_at(i), i == 8);
  EXPECT_FALSE(recorder.read().has_value());
  recorder.finish();
  const auto ticks = recorder.read();
  ASSERT_TRUE(ticks.has_value());
  EXPECT_EQ(ticks->size(), 10u);
}

TEST(FaultRecorder, DoesNothingForbidden) {
  if (!test::rt_guard_works()) GTEST_SKIP() << "a sanitizer owns malloc";
  FaultRecorder recorder;
  test::RtGuard guard;
  for (int i = 0; i < 5000; ++i) recorder.add({}, i % 1500 == 0);
  EXPECT_EQ(guard.stop().total(), 0);
}

// For the thread sanitizer: rings change hands whole.
TEST(FaultRecorder, IsTakenWhileItIsFilled) {
  FaultRecorder recorder;
  std::atomic<bool> done{false};
  std::thread haptics([&] {
    for (int i = 0; i < 100'000; ++i) recorder.add(tick_at(i), i % 300 == 0);
    done = true;
  });
  int taken = 0;
  while (!done || taken == 0) {
    const auto ticks = recorder.read();
    if (!ticks) continue;
    ++taken;
    for (std::size_t i = 1; i < ticks->size(); ++i) {
      ASSERT_EQ((*ticks)[i].rendered_N, (*ticks)[i - 1].rendered_N + 1.0);
    }
  }
  haptics.join();
}

TEST(FaultRecorder, WritesATable) {
  const test::TemporaryFolder folder;
  FaultTick tick;
  tick.loop_time_s = 1.5;
  tick.position_m = 2.5e-3;
  tick.commanded_N = 3.0;
  tick.faults = 256;
  tick.device_faults = 1;
  tick.samples = 1;
  ASSERT_TRUE(write_fault_file(folder.file("fault.csv"), {tick, tick}).ok());
  const std::string line = "1.5,0,0.0025,0,3,0,0,0,1,256,1,0\n";
  EXPECT_EQ(test::read_text(folder.file("fault.csv")),
            "loop_time_s,sample_time_s,position_m,velocity_m_per_s,commanded_N,rendered_N,sample_age_s,"
            "round_trip_s,samples,faults,device_faults,limiter_flags\n" +
                line + line);
  EXPECT_FALSE(write_fault_file(folder.file("fault.csv"), {}).ok()) << "never writes over";
}

}  // namespace
}  // namespace palpate
