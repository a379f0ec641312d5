// A 3Dconnexion SpaceMouse: pushing its cap down moves the target of a MouseDevice into the block. It renders no force
// to the hand; the force acts on the simulated mass of the MouseDevice. It sends 60 to 125 reports a second, none at
// rest. The low-pass filter of the MouseDevice turns the steps of the target into a motion at every tick.
#pragma once

#include <cstdint>
#include <utility>

#include "devices/link/device_calibration.h"
#include "devices/link/device_link.h"
#include "devices/virtual/mouse_device.h"

namespace palpate {

class SpaceMouse final : public LinkListener {
 public:
  SpaceMouse(DeviceBus& bus, const DeviceCalibration& calibration, OpenedDevice opened)
      : calibration_(calibration), link_(bus, *this, std::move(opened)) {}

  // Slow side: moves `tool` until `stop`. Errors: a thread cannot be started.
  Status start(MouseDevice& tool);
  void stop() noexcept { link_.stop(); }

  // Reader thread, wait-free.
  void connected(double) noexcept override {}
  void report_arrived(const std::uint8_t* bytes, std::size_t size, double now_s) noexcept override;
  void unplugged() noexcept override;

 private:
  void deflect(int counts, double now_s) noexcept;

  DeviceCalibration calibration_;
  MouseDevice* tool_ = nullptr;  // not null after `start`
  int counts_ = 0;               // reader thread only: the deflection of the cap
  DeviceLink link_;
};

}  // namespace palpate
