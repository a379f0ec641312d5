// A haptic device on a bus (USB HID or the bridge): a DeviceEndpoint and its threads.
// A device with an incremental encoder gives neither samples nor force until it is zeroed: bring the tool to its marked
// rest position (rest_position_m of the calibration), call `start_zeroing` and hold it still. `health` has the
// progress, zeroing_words the next step. Zeroing is necessary again after the device was unplugged or restarted, or its
// encoder jumped or was stuck.
// Thread guarantee: as Device.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "devices/link/device_endpoint.h"
#include "devices/link/device_link.h"
#include "devices/link/device_stop.h"

namespace palpate {

class LinkedDevice final : public DeviceEndpoint {
 public:
  // `bus` outlives this, or is `own_bus`; `opened` has the calibration's protocol, which renders force; `name`: as in
  // --device.
  LinkedDevice(DeviceBus& bus, const DeviceCalibration& calibration, OpenedDevice opened, std::string name = "hid",
               std::unique_ptr<DeviceBus> own_bus = nullptr)
      : DeviceEndpoint(calibration, std::move(name)),
        own_bus_(std::move(own_bus)),
        measures_force_(opened.measures_force),
        link_(bus, *this, std::move(opened)) {}
  ~LinkedDevice() override { close(); }

  bool measures_force() const noexcept override { return measures_force_; }
  // Errors: a thread cannot be started.
  Status open() override {
    stop_devices_on_signals();
    return link_.start();
  }
  void close() noexcept override { link_.stop(); }
  // See DeviceLink::description.
  std::string note() const override { return link_.description(); }

 private:
  std::unique_ptr<DeviceBus> own_bus_;
  bool measures_force_;
  DeviceLink link_;
};

}  // namespace palpate
