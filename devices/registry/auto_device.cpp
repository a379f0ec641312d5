#include "devices/registry/auto_device.h"

namespace palpate {

bool AutoDevice::read(double now_s, DeviceSample& sample) noexcept {
  if (space_mouse_ != nullptr) space_mouse_->axis().drive(*this, now_s);
  const bool exploring = idle(now_s);
  // Only this thread writes exploring_.
  const bool was_exploring = exploring_.load(std::memory_order_relaxed);
  if (exploring && !was_exploring) hand_.resume_at(position_m(), now_s);
  if (!exploring && was_exploring) resume_at(hand_.position_m(), hand_.velocity_m_per_s(), now_s);
  exploring_.store(exploring, std::memory_order_relaxed);
  // A change of the source gives no sample; the tool moves from the next tick on.
  if (exploring != was_exploring) return false;
  return exploring ? hand_.read(now_s, sample) : MouseDevice::read(now_s, sample);
}

void AutoDevice::write(double force_N) noexcept {
  hand_.write(force_N);
  MouseDevice::write(force_N);
}

}  // namespace palpate
