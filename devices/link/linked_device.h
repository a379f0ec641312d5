// A haptic device on a bus (USB HID or the bridge): a DeviceEndpoint and its threads.
// A device with an incremental encoder gives neither samples nor force until it is zeroed: bring the tool to its marked
// rest position (rest_position_m of the calibration), call `start_zeroing` and hold it still. `health` has the
// progress, zeroing_words the next step. Zeroing is necessary again after the device was unplugged or restarted, or its
// encoder jumped or was stuck.
// Thread guarantee: as Device.
#pragma once

#include <memory>
#include <string>

#include "devices/link/device_endpoint.h"
#include "devices/link/device_link.h"
#include "engine/live/device.h"

namespace palpate {

class LinkedDevice final : public Device {
 public:
  // `bus` outlives this, or is `own_bus`; `opened` has the calibration's protocol, which renders force; `name`: as in
  // --device.
  LinkedDevice(DeviceBus& bus, const DeviceCalibration& calibration, OpenedDevice opened, std::string name = "hid",
               std::unique_ptr<DeviceBus> own_bus = nullptr);
  ~LinkedDevice() override { close(); }

  const std::string& name() const noexcept override { return name_; }
  SensorSpec sensor() const noexcept override;
  Holder holder() const noexcept override { return Holder::person; }
  bool measures_force() const noexcept override { return measures_force_; }
  ForceLimits limits() const noexcept override { return endpoint_.limits(); }
  // Errors: a thread cannot be started.
  Status open() override;
  void close() noexcept override { link_.stop(); }
  bool read(double, DeviceSample& sample) noexcept override { return endpoint_.read(sample); }
  void write(double force_N) noexcept override { endpoint_.write(force_N); }
  DeviceHealth health(double now_s) noexcept override { return endpoint_.health(now_s); }
  void start_zeroing() noexcept override { endpoint_.start_zeroing(); }
  // See DeviceLink::description.
  std::string note() const override { return link_.description(); }

 private:
  std::unique_ptr<DeviceBus> own_bus_;
  std::string name_;
  bool measures_force_;
  DeviceEndpoint endpoint_;
  DeviceLink link_;
};

}  // namespace palpate
