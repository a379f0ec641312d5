// The true force of a scene's virtual material under the same tool: the reference of a session without a force
// sensor. A replayed recording has its own measured force instead.
// Thread guarantee: as ReferenceForce; `step` is wait-free and allocates nothing.
#pragma once

#include <memory>

#include "engine/live/live_tick.h"
#include "scenes/material/material.h"

namespace palpate {

class TrueForce final : public ReferenceForce {
 public:
  explicit TrueForce(const Material& material) : block_(material.make_block()) {}

  // At the first step, and at one with `restart`, the block is fully relaxed under the tool. The filters of the
  // models begin in the same state.
  double step(const TickSnapshot& snapshot, bool restart) noexcept override {
    if (restart || !started_) {
      block_->reset(snapshot.position_m);
      time_s_ = snapshot.time_s;
      started_ = true;
      return block_->force_N();
    }
    // A time that is not later leaves the block and its force unchanged.
    const double force_N = block_->step(snapshot.position_m, snapshot.velocity_m_per_s, snapshot.time_s - time_s_);
    if (snapshot.time_s > time_s_) time_s_ = snapshot.time_s;
    return force_N;
  }

 private:
  std::unique_ptr<Block> block_;
  double time_s_ = 0.0;
  bool started_ = false;
};

}  // namespace palpate
