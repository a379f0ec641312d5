// The haptics thread: its statistics, and its data shared with other threads.
#include "engine/live/haptics_loop.h"

#include <gtest/gtest.h>

#include "tests/support/live_doubles.h"

namespace palpate {
namespace {

using test::FakePacer;
using test::PathDevice;
using test::spring;

constexpr std::int64_t kMs = 1'000'000;

std::unique_ptr<LiveModels> springs(std::uint32_t id, const Device& device) {
  return std::make_unique<LiveModels>(id, device.sensor(), ForceModels{spring(300.0), spring(500.0)});
}

TEST(Deadlines, StayOnTheirGridAndSkipWhatWasMissed) {
  struct Case {
    std::int64_t now_ns, lateness_ns;
    std::uint64_t missed;
    std::int64_t next_ns;
  };
  const Case cases[] = {{kMs + 30'000, 30'000, 0, 2 * kMs},  // not 1 ms from now
                        {3 * kMs - 1, kMs - 1, 0, 3 * kMs},  // late, but before the next one
                        {3 * kMs - 5, 0, 0, 4 * kMs},        // too early is not late
                        {9 * kMs + 200, 5 * kMs + 200, 5, 10 * kMs},
                        {11 * kMs, kMs, 1, 12 * kMs}};  // exactly at the next one counts as its end
  Deadlines deadlines(0, kMs);
  EXPECT_EQ(deadlines.next_ns(), kMs);
  for (const Case& one : cases) {
    const Wake wake = deadlines.wake(one.now_ns);
    EXPECT_EQ(wake.lateness_ns, one.lateness_ns) << one.now_ns;
    EXPECT_EQ(wake.missed, one.missed) << one.now_ns;
    EXPECT_EQ(deadlines.next_ns(), one.next_ns) << one.now_ns;
  }
}

TEST(HapticsLoop, CountsTicksLatenessAndMissedDeadlines) {
  PathDevice device(test::held_5mm);
  HapticsLoop loop(device);
  loop.publish_models(springs(1, device));
  FakePacer pacer([&](int wait) -> std::int64_t {
    if (wait == 999) loop.request_stop();
    if (wait == 500) return 3 * kMs + 100'000;
    return wait % 10 == 0 ? 200'000 : 20'000;
  });
  loop.run(pacer);
  const LoopStatistics statistics = loop.statistics();
  EXPECT_EQ(statistics.ticks, 1000u) << "one a wait, no burst after the stall";
  EXPECT_EQ(statistics.missed_deadlines, 3u);
  EXPECT_EQ(statistics.lateness.count, 1000u);
  EXPECT_NEAR(statistics.lateness.p50_us, 20.0, 0.032 * 20.0) << "a bin's width";
  EXPECT_NEAR(statistics.lateness.p99_us, 200.0, 0.032 * 200.0);
  EXPECT_EQ(statistics.lateness.max_us, 3100.0);

  std::vector<LoopSnapshot> snapshots(2000);
  ASSERT_EQ(loop.read_snapshots(snapshots.data(), snapshots.size()), 1000u);
  EXPECT_EQ(snapshots[499].missed_deadlines, 0u);
  EXPECT_EQ(snapshots[500].missed_deadlines, 3u);
  EXPECT_NE(snapshots[500].faults & loop_fault::kDeadlineMissed, 0u);
  EXPECT_EQ(snapshots[501].faults & loop_fault::kDeadlineMissed, 0u);
  EXPECT_EQ(snapshots[999].missed_deadlines, 3u);
  EXPECT_EQ(snapshots[999].faults_latched & loop_fault::kDeadlineMissed, 0u) << "the count tells";
  for (std::size_t i = 1; i < 1000; ++i) {
    ASSERT_EQ(snapshots[i].tick.tick, snapshots[i - 1].tick.tick + 1);
    ASSERT_GT(snapshots[i].loop_time_s, snapshots[i - 1].loop_time_s);
  }
  EXPECT_EQ(loop.newest().tick.tick, snapshots[999].tick.tick);
  EXPECT_EQ(device.force_N(), 0.0) << "it lets go at the end";
}

TEST(HapticsLoop, RehearsesTwiceBeforeADeadlineUnlessItWakesLate) {
  PathDevice device(test::held_5mm);
  LoopSettings settings;
  settings.rehearse_ns = 60'000;
  HapticsLoop loop(device, settings);
  auto counting = std::make_shared<test::CountingModel>();
  loop.publish_models(std::make_unique<LiveModels>(1, device.sensor(), ForceModels{counting}));
  std::vector<std::uint64_t> evaluations;
  // Each tick waits three times: for the wake-up, for the last quarter before the deadline,
  // and for the deadline. A tick that wakes up too late waits twice.
  constexpr int kWakesLate = 30;
  constexpr int kStays = 45;
  FakePacer pacer([&](int wait) -> std::int64_t {
    evaluations.push_back(counting->evaluations());
    if (wait == 58) loop.request_stop();  // the last wait of 20 ticks
    if (wait == kWakesLate) return 40'000;
    if (wait == kStays) return 10'000;  // most of the last quarter is over
    return 0;
  });
  loop.run(pacer);
  EXPECT_EQ(loop.statistics().ticks, 20u);
  EXPECT_EQ(loop.statistics().lateness.max_us, 0.0) << "waking up late is not being late";
  // Between the waits are a rehearsal, a second rehearsal, and the tick.
  const auto between = [&](std::size_t wait) { return evaluations[wait + 1] - evaluations[wait]; };
  for (std::size_t wait = 3; wait < kWakesLate; ++wait) EXPECT_EQ(between(wait), 1u) << wait;
  EXPECT_EQ(between(kWakesLate), 0u) << "no time for any";
  EXPECT_EQ(between(kStays - 1), 1u);
  EXPECT_EQ(between(kStays), 0u) << "no time for a second one";
  EXPECT_EQ(between(kStays + 1), 1u) << "the tick";
}

TEST(HapticsLoop, DropsAndCountsSnapshotsThatNobodyReads) {
  PathDevice device(test::held_5mm);
  HapticsLoop loop(device);
  constexpr int kTicks = static_cast<int>(kSnapshotRing) + 10;
  FakePacer pacer([&](int wait) -> std::int64_t {
    if (wait == kTicks - 1) loop.request_stop();
    return 0;
  });
  loop.run(pacer);
  EXPECT_EQ(loop.statistics().dropped_snapshots, 10u);
}

// The real clock and thread, while another thread publishes models, changes the
// selected model and reads snapshots. The checks do not depend on timing; the
// thread sanitizer checks for data races.
TEST(HapticsLoop, RunsBesideABusySlowSide) {
  PathDevice device(test::strokes);
  LoopSettings settings;
  settings.realtime = false;  // tests do not need real-time priority
  settings.rehearse_ns = 60'000;
  HapticsLoop loop(device, settings);
  loop.publish_models(springs(1, device));
  ASSERT_TRUE(loop.start().ok());
  EXPECT_EQ(loop.scheduling().scheduling, "normal, as requested");

  std::vector<LoopSnapshot> snapshots(64);
  std::uint64_t received = 0;
  std::uint64_t wrong = 0;
  std::uint64_t last_tick = 0;
  std::uint32_t id = 1;
  while (loop.statistics().ticks < 500) {
    const std::size_t count = loop.read_snapshots(snapshots.data(), snapshots.size());
    for (std::size_t i = 0; i < count; ++i) {
      if (snapshots[i].tick.tick <= last_tick || snapshots[i].models_id > id) ++wrong;
      last_tick = snapshots[i].tick.tick;
    }
    received += count;
    if (loop.newest().tick.tick + 1 < last_tick) ++wrong;
    if (id < 30) loop.publish_models(springs(++id, device));
    loop.set_controls({id, id % 2});
    loop.collect_models();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  loop.stop();
  for (std::size_t count = 1; count > 0; received += count) {
    count = loop.read_snapshots(snapshots.data(), snapshots.size());
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(received + loop.statistics().dropped_snapshots, loop.statistics().ticks);
  EXPECT_GT(loop.newest().models_id, 1u);
  EXPECT_EQ(device.force_N(), 0.0);
  loop.stop();  // a second call has no effect
}

}  // namespace
}  // namespace palpate
