#include "engine/live/device.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>

namespace palpate {
namespace {

TEST(Faults, EveryBitHasOneRow) {
  for (const FaultSource source : {FaultSource::device, FaultSource::loop}) {
    std::uint32_t seen = 0;
    for (const Fault& fault : kFaults) {
      if (fault.source != source) continue;
      EXPECT_TRUE(std::has_single_bit(fault.bit));
      EXPECT_EQ(seen & fault.bit, 0u) << fault.sentence;
      seen |= fault.bit;
    }
    EXPECT_EQ(seen, fault_bits_of(source));
    EXPECT_TRUE(std::has_single_bit(seen + 1)) << "no gap between the bits";
  }
}

TEST(Faults, EveryAlarmHasASentenceAndEveryFaultOfADeviceStopsTheForce) {
  for (const Fault& fault : kFaults) {
    EXPECT_TRUE(!fault.alarm || std::strlen(fault.sentence) > 10);
    EXPECT_TRUE(fault.source != FaultSource::device || std::strstr(fault.sentence, ": ") != nullptr)
        << "what happened, then what to do";
    EXPECT_TRUE(fault.source != FaultSource::device || (fault.alarm && fault.stops_force)) << fault.sentence;
  }
  using namespace loop_fault;
  EXPECT_EQ(fault_bits_of(FaultSource::loop, true),
            kBadSample | kModelNotFinite | kForceNotFinite | kStaleSample | kDeviceFault);
}

TEST(Faults, TellsTheAlarmsAmongTheBits) {
  using namespace loop_fault;
  EXPECT_EQ(alarm_words(FaultSource::loop, kForceSlewed | kDeadlineMissed | kDeviceFault), std::vector<std::string>{});
  const std::size_t row = fault_index(FaultSource::loop, kForceThermal);
  EXPECT_EQ(alarm_words(FaultSource::loop, kForceThermal), std::vector<std::string>{kFaults[row].sentence});
  EXPECT_EQ(device_fault_words(fault_bits_of(FaultSource::device)).size(), 12u);
}

}  // namespace
}  // namespace palpate
