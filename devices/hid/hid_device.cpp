#include "devices/hid/hid_device.h"

#include <utility>

#include "devices/hid/device_stop.h"

namespace palpate {

HidDevice::HidDevice(HidBus& bus, const HidCalibration& calibration, HidOpened opened)
    : endpoint_(calibration), link_(bus, endpoint_, std::move(opened)) {}

SensorSpec HidDevice::sensor() const noexcept {
  SensorSpec sensor;
  sensor.encoder_step_m = 1.0 / endpoint_.calibration().counts_per_metre;
  return sensor;
}

Status HidDevice::open() {
  stop_devices_on_signals();
  return link_.start();
}

}  // namespace palpate
