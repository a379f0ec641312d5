#include "engine/tick/motion_history.h"

namespace palpate {
namespace {

// The filters are exact for steps of any length with a constant velocity, and that of a hand changes little in a step.
constexpr double kStep_s = 3.9e-3;
constexpr double kRemembered_s = 60.0;

}  // namespace

void MotionHistory::add(const TickSnapshot& snapshot, bool restarted) {
  if (restarted || (!past_.empty() && snapshot.time_s < past_.back().time_s)) past_.clear();
  if (snapshot.fault == TickFault::bad_sample || snapshot.fault == TickFault::time_not_later) return;
  if (!past_.empty() && snapshot.time_s - past_.back().time_s < kStep_s) return;
  past_.push_back({snapshot.time_s, snapshot.position_m, snapshot.velocity_m_per_s});
  while (snapshot.time_s - past_.front().time_s > kRemembered_s) past_.pop_front();
}

void MotionHistory::recall(HapticsTick& tick) const {
  for (const PastMotion& motion : past_) tick.recall(motion);
}

}  // namespace palpate
