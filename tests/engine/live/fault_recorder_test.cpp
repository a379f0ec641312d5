// The recorded ticks around a fault.
#include "engine/live/haptics_loop.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

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

TEST(FaultRecorder, TellsOfEveryFaultAndOfWhatThereIs) {
  FaultRecorder recorder;
  const auto faulty = [](int i) { return i == 500 || i == 550 || i == 2000; };
  EXPECT_EQ(whole_at(recorder, 0, 3000, faulty), 600);
  EXPECT_EQ(recorder.ticks().size(), 601u) << "the loop had not run for a second";
  EXPECT_EQ(whole_at(recorder, 601, 3000, faulty), 2100) << "550 was part of the first";
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

}  // namespace
}  // namespace palpate
