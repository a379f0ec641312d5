#include "scenes/live/fault_log.h"

#include <algorithm>

static_assert(palpate::device_fault::kAll == (1U << 11) - 1, "a kind for each bit, see kDeviceBits");

namespace palpate {
namespace {

constexpr double kSameEvent_s = 1.0;
constexpr double kRememberedDeadlines = 10'000.0;

enum Kind : std::size_t {
  kBadSample,
  kTimeNotLater,
  kModelNotFinite,
  kForceNotFinite,
  kForceClamped,
  kDeadlineMissed,
  kDropped,
  kStall,
  kStaleSample,
  kForceThermal,
  kDevice,  // and those behind it: device_fault's bits, in their order
};
constexpr std::size_t kDeviceBits = 11;

constexpr std::array<const char*, kDevice> kWords = {
    "the device gave a sample that is not a number; the force let go",
    "the device gave a sample that is not later than the one before; skipped",
    "a model gave a force that is not a number; 0 N instead",
    "the force became not a number; 0 N instead",
    "the force was above what the device may be given; held back",
    "a tick was late and its deadline missed",
    "the window was too slow to show every tick",
    "the haptics loop stood still for more than 50 ms",
    "the device's newest sample is too old to push by; the force let go",
    "the motor is near its thermal limit; the force held back",
};

std::string words_of(std::size_t kind) {
  if (kind < kDevice) return kWords[kind];
  return device_fault_words(1U << (kind - kDevice)).front();
}

struct BitKind {
  std::uint32_t bit;
  Kind kind;
};
// A force that the limiter slews is none of these: it does so at every ramp, and
// when the tool hits the block hard, and that is what it is for.
constexpr std::array<BitKind, 7> kAlarms = {{
    {loop_fault::kBadSample, kBadSample},
    {loop_fault::kTimeNotLater, kTimeNotLater},
    {loop_fault::kModelNotFinite, kModelNotFinite},
    {loop_fault::kForceNotFinite, kForceNotFinite},
    {loop_fault::kForceClamped, kForceClamped},
    {loop_fault::kStaleSample, kStaleSample},
    {loop_fault::kForceThermal, kForceThermal},
}};

}  // namespace

TickTrouble FaultLog::see(const LoopSnapshot& snapshot) {
  TickTrouble trouble = TickTrouble::none;
  for (const BitKind& alarm : kAlarms) {
    if ((snapshot.faults & alarm.bit) == 0) continue;
    note(alarm.kind, 1, snapshot.loop_time_s);
    trouble = TickTrouble::alarm;
  }
  see_device(snapshot.device.faults, snapshot.loop_time_s);
  if (snapshot.device.faults != 0) trouble = TickTrouble::alarm;
  const auto missed = static_cast<double>(snapshot.missed_deadlines - missed_);
  missed_of_late_ += std::min(1.0, (missed + 1.0) / kRememberedDeadlines) * (missed / (missed + 1.0) - missed_of_late_);
  if (snapshot.missed_deadlines > missed_) {
    note(kDeadlineMissed, snapshot.missed_deadlines - missed_, snapshot.loop_time_s);
    missed_ = snapshot.missed_deadlines;
    if (trouble == TickTrouble::none) trouble = TickTrouble::late;
  }
  return trouble;
}

// Once when it begins, however long it lasts.
void FaultLog::see_device(std::uint32_t faults, double at_s) {
  for (std::size_t i = 0; i < kDeviceBits; ++i) {
    if ((faults & ~device_faults_ & (1U << i)) != 0) note(kDevice + i, 1, at_s);
  }
  device_faults_ = faults;
}

void FaultLog::see_dropped(std::uint64_t dropped, double now_s) {
  if (dropped > dropped_) note(kDropped, dropped - dropped_, now_s);
  dropped_ = dropped;
}

void FaultLog::see_age(double age_s, double now_s) {
  const bool stalled = age_s > kStall_s;
  if (stalled && !stalled_) note(kStall, 1, now_s);
  stalled_ = stalled;
  stall_unseen_ = stall_unseen_ || stalled;
}

std::vector<std::string> FaultLog::alarms(const LoopSnapshot& newest) const {
  std::vector<std::string> words = device_fault_words(newest.device_faults_latched);
  for (const BitKind& alarm : kAlarms) {
    if ((newest.faults_latched & alarm.bit) != 0) words.emplace_back(kWords[alarm.kind]);
  }
  if (stall_unseen_) words.emplace_back(kWords[kStall]);
  return words;
}

void FaultLog::note(std::size_t kind, std::uint64_t count, double at_s) {
  Last& last = last_[kind];
  if (last.event != kMost && at_s - last.at_s <= kSameEvent_s) {
    events_[last.event].count += count;
    last.at_s = at_s;
    return;
  }
  if (events_.size() == kMost) {
    events_.erase(events_.begin());
    for (Last& other : last_) {
      if (other.event != kMost) other.event = other.event > 0 ? other.event - 1 : kMost;
    }
  }
  events_.push_back({at_s, words_of(kind), count, kind != kDeadlineMissed && kind != kDropped});
  last = {events_.size() - 1, at_s};
}

}  // namespace palpate
