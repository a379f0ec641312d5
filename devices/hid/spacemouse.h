// A 3Dconnexion SpaceMouse: pushing its cap down moves the target of a MouseDevice into the block. It renders no force
// to the hand; the force acts on the simulated mass of the MouseDevice. It sends 60 to 125 reports a second, none at
// rest. The low-pass filter of the MouseDevice turns the steps of the target into a motion at every tick.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "devices/link/device_calibration.h"
#include "devices/link/device_link.h"
#include "devices/virtual/mouse_device.h"

namespace palpate {

class SpaceMouse final : public LinkListener {
 public:
  // `bus` outlives this.
  SpaceMouse(DeviceBus& bus, const DeviceCalibration& calibration, OpenedDevice opened)
      : calibration_(calibration), link_(bus, *this, std::move(opened)) {}

  // Slow side: moves `tool` until `stop`. Errors: a thread cannot be started.
  Status start(MouseDevice& tool);
  void stop() noexcept { link_.stop(); }
  std::string description() const { return link_.description(); }
  // Any thread, wait-free. Bits of device_fault; an unreadable report counts for 0.1 s.
  std::uint32_t faults(double now_s) const noexcept;

  // Reader thread, wait-free.
  void connected(double) noexcept override { connected_.store(true, std::memory_order_relaxed); }
  void report_arrived(const std::uint8_t* bytes, std::size_t size, double now_s) noexcept override;
  void unplugged() noexcept override;

 private:
  void deflect(int counts, double now_s) noexcept;

  DeviceCalibration calibration_;
  std::atomic<bool> connected_{false};
  std::atomic<double> corrupt_until_s_{0.0};
  static_assert(std::atomic<double>::is_always_lock_free);
  MouseDevice* tool_ = nullptr;  // not null after `start`
  int counts_ = 0;               // reader thread only: the deflection of the cap
  DeviceLink link_;
};

// The device "hid" when a SpaceMouse is plugged in and no haptic device.
class SpaceMouseDevice final : public MouseDevice {
 public:
  explicit SpaceMouseDevice(std::unique_ptr<SpaceMouse> mouse) : MouseDevice("hid"), mouse_(std::move(mouse)) {}
  ~SpaceMouseDevice() override { close(); }

  Status open() override { return mouse_->start(*this); }
  void close() noexcept override { mouse_->stop(); }
  DeviceHealth health(double now_s) noexcept override { return {.faults = mouse_->faults(now_s)}; }
  std::string note() const override { return mouse_->description(); }
  ToolInput* tool_input() noexcept override { return nullptr; }  // only the SpaceMouse moves the tool

 private:
  std::unique_ptr<SpaceMouse> mouse_;
};

}  // namespace palpate
