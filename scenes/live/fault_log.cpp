#include "scenes/live/fault_log.h"

#include <algorithm>
#include <utility>

namespace palpate {

constexpr double kSameEvent_s = 1.0;
constexpr double kRememberedDeadlines = 10'000.0;

constexpr std::size_t kDeadlineMissed = fault_index(FaultSource::loop, loop_fault::kDeadlineMissed);
// What only the reader of the snapshots notices.
constexpr const char* kDropped = "the window was too slow to show every tick";
constexpr const char* kStall = "the haptics loop stood still for more than 50 ms";

TickFaultLevel FaultLog::update(const LoopSnapshot& snapshot) {
  TickFaultLevel fault_level = TickFaultLevel::none;
  for (const Fault& fault : kFaults) {
    if (fault.source == FaultSource::loop && fault.alarm && (snapshot.faults & fault.bit) != 0) {
      note(fault.sentence, 1, snapshot.loop_time_s);
      fault_level = TickFaultLevel::alarm;
    }
    // Each device fault is logged once, when it begins.
    const bool begins = (snapshot.device.faults & ~device_faults_ & fault.bit) != 0;
    if (fault.source == FaultSource::device && begins) note(fault.sentence, 1, snapshot.loop_time_s);
  }
  device_faults_ = snapshot.device.faults;
  if (device_faults_ != 0) fault_level = TickFaultLevel::alarm;
  const auto missed = static_cast<double>(snapshot.missed_deadlines - missed_);
  missed_of_late_ += std::min(1.0, (missed + 1.0) / kRememberedDeadlines) * (missed / (missed + 1.0) - missed_of_late_);
  if (snapshot.missed_deadlines > missed_) {
    note(kFaults[kDeadlineMissed].sentence, snapshot.missed_deadlines - missed_, snapshot.loop_time_s);
    missed_ = snapshot.missed_deadlines;
    if (fault_level == TickFaultLevel::none) fault_level = TickFaultLevel::late;
  }
  return fault_level;
}

void FaultLog::update_window(std::uint64_t dropped, double age_s, double now_s) {
  if (dropped > dropped_) note(kDropped, dropped - dropped_, now_s);
  dropped_ = dropped;
  const bool stalled = age_s > kStall_s;
  if (stalled && !stalled_) note(kStall, 1, now_s);
  stalled_ = stalled;
  stall_unseen_ = stall_unseen_ || stalled;
}

std::vector<std::string> FaultLog::alarms(const LoopSnapshot& newest) const {
  std::vector<std::string> words = device_fault_words(newest.device_faults_latched);
  for (std::string& alarm : alarm_words(FaultSource::loop, newest.faults_latched)) words.push_back(std::move(alarm));
  if (stall_unseen_) words.emplace_back(kStall);
  return words;
}

void FaultLog::note(const std::string& text, std::uint64_t count, double at_s) {
  const auto same =
      std::find_if(events_.rbegin(), events_.rend(), [&](const FaultEvent& event) { return event.text == text; });
  if (same != events_.rend() && at_s - same->last_s <= kSameEvent_s) {
    same->count += count;
    same->last_s = at_s;
    return;
  }
  if (events_.size() == kMost) events_.erase(events_.begin());
  events_.push_back({at_s, text, count, at_s});
}

}  // namespace palpate
