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

class AutoDevice final : public Device, public ToolInput {
 public:
  explicit AutoDevice(std::uint64_t seed = 1, const HandSettings& hand = {}, const MouseSettings& mouse = {})
      : hand_(seed, hand), mouse_(mouse) {}

  // Call them before `open`: the text of `note`, and a SpaceMouse if there is one.
  void explain(std::string note) { note_ = std::move(note); }
  void use(std::unique_ptr<SpaceMouse> space_mouse) { space_mouse_ = std::move(space_mouse); }

  const std::string& name() const noexcept override { return name_; }
  Status open() override { return space_mouse_ != nullptr ? space_mouse_->start() : Status(); }
  void close() noexcept override {
    if (space_mouse_ != nullptr) space_mouse_->stop();
  }
  std::string note() const override { return note_; }
  SensorSpec sensor() const noexcept override { return hand_.sensor(); }
  Holder holder() const noexcept override { return Holder::simulated; }
  ForceLimits limits() const noexcept override { return kSimulatedLimits; }
  bool read(double now_s, DeviceSample& sample) noexcept override;
  void write(double force_N) noexcept override;

  ToolInput* tool_input() noexcept override { return this; }
  // A target stops the simulated hand.
  void set_target(double position_m, double now_s) noexcept override { mouse_.set_target(position_m, now_s); }
  void nudge(double by_m, double now_s) noexcept override { mouse_.nudge(by_m, now_s); }
  void drive(double velocity_m_per_s, double limit_m, double now_s) noexcept override {
    mouse_.drive(velocity_m_per_s, limit_m, now_s);
  }
  void release() noexcept override { mouse_.release(); }
  // Any thread, wait-free.
  bool hand_is_exploring() const noexcept override { return exploring_.load(std::memory_order_relaxed); }

 private:
  std::string name_ = "auto";
  std::string note_;
  std::unique_ptr<SpaceMouse> space_mouse_;
  HandDevice hand_;
  MouseDevice mouse_;
  std::atomic<bool> exploring_{true};
};

}  // namespace palpate
