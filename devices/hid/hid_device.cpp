#include "devices/hid/hid_device.h"

#include <algorithm>
#include <utility>

#include "devices/hid/device_stop.h"

namespace palpate {

HidDevice::HidDevice(HidBus& bus, const HidCalibration& calibration, HidOpened opened)
    : endpoint_(calibration), link_(bus, endpoint_, std::move(opened)) {}

HidDevice::HidDevice(std::unique_ptr<HidBus> bus, const HidCalibration& calibration, HidOpened opened, std::string name)
    : own_bus_(std::move(bus)),
      name_(std::move(name)),
      measures_force_(opened.measures_force),
      endpoint_(calibration),
      link_(*own_bus_, endpoint_, std::move(opened)) {}

SensorSpec HidDevice::sensor() const noexcept {
  const HidCalibration& calibration = endpoint_.calibration();
  SensorSpec sensor;
  sensor.encoder_step_m = std::max(calibration.encoder_step_m, 1.0 / calibration.counts_per_metre);
  return sensor;
}

Status HidDevice::open() {
  stop_devices_on_signals();
  return link_.start();
}

}  // namespace palpate
