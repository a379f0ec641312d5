#include "engine/live/haptics_loop.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <utility>

#include "tests/support/live_doubles.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

// The haptics thread: its statistics, and its data shared with other threads.

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

// The exchange of data between two threads. The stress tests also run under the thread sanitizer.

// A value is torn if its words differ.
struct Words {
  std::array<std::uint64_t, 40> all{};
};

Words words(std::uint64_t value) {
  Words result;
  result.all.fill(value);
  return result;
}

TEST(TripleBuffer, UnderStressIsNeverTornNeverBackwardsAndEndsWithTheNewest) {
  constexpr std::uint64_t kLast = 200000;
  TripleBuffer<Words> buffer;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) buffer.write(words(i));
  });
  std::uint64_t seen = 0;
  std::uint64_t torn = 0;
  std::uint64_t backwards = 0;
  while (seen < kLast) {
    const bool fresh = buffer.refresh();
    const Words& value = buffer.value();
    for (const std::uint64_t word : value.all) torn += word != value.all[0] ? 1 : 0;
    if (fresh ? value.all[0] <= seen : value.all[0] != seen) ++backwards;
    seen = value.all[0];
  }
  writer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(backwards, 0u);
  EXPECT_FALSE(buffer.refresh());
}

TEST(SpscRing, KeepsOrderAndDropsTheNewWhenFull) {
  SpscRing<int, 4> ring;
  for (int i = 1; i <= 4; ++i) EXPECT_TRUE(ring.push(i));
  EXPECT_FALSE(ring.push(5));
  EXPECT_FALSE(ring.push(6));
  EXPECT_EQ(ring.dropped(), 2u);
  int value = 0;
  for (int i = 1; i <= 4; ++i) {
    ASSERT_TRUE(ring.pop(value));
    EXPECT_EQ(value, i);
  }
  EXPECT_FALSE(ring.pop(value));
  EXPECT_EQ(value, 4) << "as it was";
  EXPECT_TRUE(ring.push(7));
}

TEST(SpscRing, UnderStressLosesOnlyWhatItCounts) {
  constexpr std::uint64_t kLast = 300000;
  struct Pair {
    std::uint64_t value = 0;
    std::uint64_t again = 0;
  };
  SpscRing<Pair, 64> ring;
  std::uint64_t sent = 0;
  std::thread producer([&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) sent += ring.push({i, i}) ? 1 : 0;
    // Retries the last value until it is accepted.
    while (!ring.push({kLast + 1, kLast + 1})) std::this_thread::yield();
    ++sent;
  });
  std::array<Pair, 10> values;
  std::uint64_t received = 0;
  std::uint64_t wrong = 0;
  std::uint64_t last = 0;
  while (last <= kLast) {
    const std::size_t count = ring.pop(values.data(), values.size());
    for (std::size_t i = 0; i < count; ++i) {
      if (values[i].value != values[i].again || values[i].value <= last) ++wrong;
      last = values[i].value;
    }
    received += count;
    if (count == 0) std::this_thread::yield();
  }
  producer.join();
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(received, sent);
  EXPECT_GE(ring.dropped() + sent, kLast + 1) << "the last one may have been dropped several times";
}

// A set of models, which counts how many exist and how many the tick deleted.
std::atomic<int> alive{0};
thread_local bool in_tick = false;
std::atomic<int> deleted_in_tick{0};

struct Set {
  explicit Set(int n) : number(n), number_again(n) { ++alive; }
  Set(const Set&) = delete;
  Set& operator=(const Set&) = delete;
  ~Set() {
    --alive;
    if (in_tick) ++deleted_in_tick;
    number = -1;
  }
  int number;
  int number_again;
};

TEST(ModelSlot, HandsOverTheNewestAndDeletesTheOthersOnTheSlowSide) {
  {
    ModelSlot<Set> slot;
    EXPECT_EQ(slot.acquire(), nullptr);
    slot.publish(std::make_unique<Set>(1));
    slot.publish(std::make_unique<Set>(2));
    EXPECT_EQ(alive, 1) << "the first was never taken";
    std::unique_ptr<Set> taken = slot.acquire();
    ASSERT_NE(taken, nullptr);
    EXPECT_EQ(taken->number, 2);
    EXPECT_EQ(slot.acquire(), nullptr);
    slot.publish(std::make_unique<Set>(3));
    slot.retire(std::move(taken));
    EXPECT_EQ(alive, 2) << "not deleted by the tick";
    EXPECT_EQ(slot.acquire(), nullptr) << "the retired one is not yet deleted";
    EXPECT_TRUE(slot.collect());
    EXPECT_FALSE(slot.collect());
    slot.retire(slot.acquire());
    slot.publish(std::make_unique<Set>(4));
    EXPECT_EQ(alive, 1) << "publishing collects as well";
    slot.retire(slot.acquire());
    slot.publish(std::make_unique<Set>(5));
  }
  EXPECT_EQ(alive, 0) << "and so does the end";
}

TEST(ModelSlot, UnderStressEverySetIsDeletedOnceAndNeverInTheTick) {
  constexpr int kLast = 20000;
  deleted_in_tick = 0;
  {
    ModelSlot<Set> slot;
    std::atomic<int> wrong{0};
    std::thread haptics([&] {
      in_tick = true;
      auto current = std::make_unique<Set>(0);
      while (current->number < kLast) {
        std::unique_ptr<Set> next = slot.acquire();
        if (next == nullptr) {
          std::this_thread::yield();
          continue;
        }
        if (next->number <= current->number || next->number != next->number_again) ++wrong;
        slot.retire(std::exchange(current, std::move(next)));
      }
      in_tick = false;  // the last set is deleted by the end of the thread
    });
    for (int i = 1; i <= kLast; ++i) {
      slot.publish(std::make_unique<Set>(i));
      if (i % 3 == 0) std::this_thread::yield();
    }
    // Until the set before is deleted, the tick cannot take the last one.
    while (alive > 0) {
      slot.collect();
      std::this_thread::yield();
    }
    haptics.join();
    EXPECT_EQ(wrong, 0);
  }
  EXPECT_EQ(alive, 0);
  EXPECT_EQ(deleted_in_tick, 0);
}

// The recorded ticks around a fault.

LoopSnapshot tick_at(int index, bool fault) {
  LoopSnapshot tick;
  tick.rendered_N = index;
  tick.faults = fault ? loop_fault::kDeviceFault : 0;
  return tick;
}

// The tick at which the record of the next fault is complete; -1: none before `end`.
int whole_at(FaultRecorder& recorder, int begin, int end, bool (*faulty)(int)) {
  for (int i = begin; i < end; ++i) {
    if (recorder.add(tick_at(i, faulty(i)))) return i;
  }
  return -1;
}

TEST(FaultRecorder, KeepsTheLastSecondAroundAFault) {
  FaultRecorder recorder;
  EXPECT_EQ(whole_at(recorder, 0, 5000, [](int i) { return i >= 4000 && i < 4050; }), 4100)
      << "until the force is gone";
  ASSERT_EQ(recorder.ticks().size(), FaultRecorder::kTicks);
  EXPECT_EQ(recorder.ticks().back().rendered_N, 4100.0);
  EXPECT_EQ(recorder.ticks().front().rendered_N, 3101.0);
  EXPECT_EQ(whole_at(recorder, 4101, 9000, [](int) { return false; }), -1) << "told once";
}

TEST(FaultRecorder, WhatDoesNotStopTheForceIsNoFault) {
  FaultRecorder recorder;
  LoopSnapshot tick;
  tick.faults = loop_fault::kForceClamped | loop_fault::kDeadlineMissed;
  for (int i = 0; i < 500; ++i) EXPECT_FALSE(recorder.add(tick));
}

TEST(FaultRecorder, WritesATable) {
  const test::TemporaryFolder folder;
  LoopSnapshot tick;
  tick.loop_time_s = 1.5;
  tick.tick.position_m = 2.5e-3;
  tick.commanded_N = 3.0;
  tick.device.sample_age_s = 0.0;
  tick.faults = 256;
  tick.device.faults = 1;
  tick.samples = 1;
  ASSERT_TRUE(write_fault_file(folder.file("fault.csv"), {tick, tick}).ok());
  const std::string line = "1.5,0,0.0025,0,3,0,0,0,1,256,1,0\n";
  EXPECT_EQ(test::read_text(folder.file("fault.csv")),
            "loop_time_s,sample_time_s,position_m,velocity_m_per_s,commanded_N,rendered_N,sample_age_s,"
            "delay_ms,samples,faults,device_faults,limiter_flags\n" +
                line + line);
  EXPECT_FALSE(write_fault_file(folder.file("fault.csv"), {}).ok()) << "never writes over";
}

// The advice if the system refuses real-time priority.

TEST(RtThread, SaysWhatWasObtained) {
  RtStatus status;
  std::thread([&] { status = make_this_thread_realtime(1, false); }).join();
  EXPECT_EQ(status.scheduling, status.realtime ? "SCHED_FIFO 1" : "normal");
  EXPECT_EQ(status.fix.empty(), status.realtime);
  EXPECT_EQ(realtime_advice(0, 0, false), "");
}

TEST(RtThread, ARefusalComesWithTheExactFix) {
  const std::string advice = realtime_advice(EPERM, ENOMEM, false);
  EXPECT_TRUE(test::has_parts(
      advice, {"Operation not permitted", "Cannot allocate memory", "/etc/security/limits.conf", " - rtprio 90\n",
               " - memlock unlimited\n", "sudo setcap cap_sys_nice,cap_ipc_lock=ep /"}));
}

TEST(RtThread, RootInAContainerIsToldAboutTheContainer) {
  const std::string advice = realtime_advice(EPERM, 0, true);
  EXPECT_TRUE(test::has_parts(advice, {"--cap-add=SYS_NICE"}));
  EXPECT_FALSE(test::has_parts(advice, {"setcap cap"}));
  EXPECT_FALSE(test::has_parts(advice, {"locked memory"}));
}

// Percentiles from a histogram, without storing the times.

TEST(TimeHistogram, GivesPercentilesWithinABin) {
  TimeHistogram histogram;
  for (std::int64_t time_us = 1; time_us <= 10000; ++time_us) histogram.add(1000 * time_us);
  const TimePercentiles result = histogram.percentiles();
  EXPECT_EQ(result.count, 10000u);
  // Bins are a 32nd of an octave, 3.2 % wide; a percentile is the upper edge of its bin.
  EXPECT_NEAR(result.p50_us, 5000.0, 0.032 * 5000.0);
  EXPECT_NEAR(result.p99_us, 9900.0, 0.032 * 9900.0);
  EXPECT_NEAR(result.p99_9_us, 9990.0, 0.032 * 9990.0);
  EXPECT_GE(result.p99_us, 9900.0) << "never flattering";
  EXPECT_EQ(result.max_us, 10000.0);
}

}  // namespace
}  // namespace palpate
