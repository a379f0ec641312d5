#include "scenes/live/true_force.h"

namespace palpate {

double TrueForce::step(const TickSnapshot& snapshot, bool restart) noexcept {
  if (restart || !started_) {
    block_->reset(snapshot.position_m);
    time_s_ = snapshot.time_s;
    started_ = true;
    return block_->force_N();
  }
  // A time that is not later changes nothing and gives the last force.
  const double force_N = block_->step(snapshot.position_m, snapshot.velocity_m_per_s, snapshot.time_s - time_s_);
  if (snapshot.time_s > time_s_) time_s_ = snapshot.time_s;
  return force_N;
}

}  // namespace palpate
