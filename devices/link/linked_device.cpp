#include "devices/link/linked_device.h"

#include <algorithm>
#include <utility>

#include "devices/link/device_stop.h"

namespace palpate {

LinkedDevice::LinkedDevice(DeviceBus& bus, const DeviceCalibration& calibration, OpenedDevice opened, std::string name,
                           std::unique_ptr<DeviceBus> own_bus)
    : own_bus_(std::move(own_bus)),
      name_(std::move(name)),
      measures_force_(opened.measures_force),
      endpoint_(calibration),
      link_(bus, endpoint_, std::move(opened)) {}

SensorSpec LinkedDevice::sensor() const noexcept {
  const DeviceCalibration& calibration = endpoint_.calibration();
  SensorSpec sensor;
  sensor.encoder_step_m = std::max(calibration.encoder_step_m, 1.0 / calibration.counts_per_metre);
  return sensor;
}

Status LinkedDevice::open() {
  stop_devices_on_signals();
  return link_.start();
}

}  // namespace palpate
