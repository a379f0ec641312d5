// This device is the simulated hand until the user moves the mouse or a SpaceMouse, and again once both have been idle
// for MouseDevice::kIdleTime_s. The tool continues from its last position.
// Thread guarantee: as Device and ToolInput.
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
  // `space_mouse`: null where there is none; `note`: see Device::note.
  explicit AutoDevice(std::uint64_t seed = 1, const HandSettings& hand = {},
                      std::unique_ptr<SpaceMouse> space_mouse = nullptr, std::string note = "")
      : MouseDevice("auto"), note_(std::move(note)), space_mouse_(std::move(space_mouse)), hand_(seed, hand) {}
  ~AutoDevice() override { close(); }

  Status open() override { return space_mouse_ != nullptr ? space_mouse_->start(*this) : Status(); }
  void close() noexcept override {
    if (space_mouse_ != nullptr) space_mouse_->stop();
  }
  std::string note() const override { return note_; }
  bool read(double now_s, DeviceSample& sample) noexcept override {
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
