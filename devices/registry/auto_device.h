// The simulated hand, until the user moves the mouse or a SpaceMouse, and again once both have been idle for
// MouseSettings::idle_time_s. The tool continues from its last position.
// Thread guarantee: as Device; `mouse` as ToolInput.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "devices/hid/spacemouse.h"
#include "devices/virtual/hand_device.h"
#include "devices/virtual/mouse_device.h"

namespace palpate {

class AutoDevice final : public MouseDevice {
 public:
  explicit AutoDevice(std::uint64_t seed = 1, const HandSettings& hand = {}, const MouseSettings& mouse = {})
      : MouseDevice(mouse, "auto"), hand_(seed, hand) {}

  // Call them before `open`: the text of `note`, and a SpaceMouse if there is one.
  void explain(std::string note) { note_ = std::move(note); }
  void use(std::unique_ptr<SpaceMouse> space_mouse) { space_mouse_ = std::move(space_mouse); }

  Status open() override { return space_mouse_ != nullptr ? space_mouse_->start() : Status(); }
  void close() noexcept override {
    if (space_mouse_ != nullptr) space_mouse_->stop();
  }
  std::string note() const override { return note_; }
  bool read(double now_s, DeviceSample& sample) noexcept override {
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
  void write(double force_N) noexcept override {
    hand_.write(force_N);
    MouseDevice::write(force_N);
  }
  // Any thread, wait-free. A target stops the simulated hand.
  bool hand_is_exploring() const noexcept override { return exploring_.load(std::memory_order_relaxed); }

 private:
  std::string note_;
  std::unique_ptr<SpaceMouse> space_mouse_;
  HandDevice hand_;
  std::atomic<bool> exploring_{true};
};

}  // namespace palpate
