// The devices by the names of the option --device.
// Thread guarantee: slow side.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "devices/link/device_link.h"
#include "devices/virtual/hand_motion.h"
#include "engine/live/device.h"

namespace palpate {

struct DeviceDescription {
  std::string name;     // as in --device
  std::string summary;  // one line
  Holder holder = Holder::none;
  std::string problem;  // why it cannot be opened and what to do; empty: it can be opened
};

struct DeviceRequest {
  std::uint64_t seed = 1;  // of the simulated hand
  HandSettings hand{};     // of the simulated hand
  // Folder of the calibrations, assets/devices, without which no HID or bridge device can be opened.
  std::string calibrations{};
  DeviceBus* bus = nullptr;  // bus of the HID devices; null: that of this machine
};

// A device of the table and its factory. `what` is the part of its name after the colon.
using MadeDevice = Result<std::unique_ptr<Device>>;
struct DeviceEntry {
  DeviceDescription description;
  MadeDevice (*make)(const std::string& what, const DeviceRequest& request);
};
// The table of all devices, the default first. A new device is a line of this table.
const std::vector<DeviceEntry>& device_entries();

// The descriptions of the table. Opens and closes HID devices to find out whether they can be used, which takes half a
// second when one cannot.
std::vector<DeviceDescription> list_devices(const DeviceRequest& request = {});

// Makes and opens the device of that name. "auto" is the first haptic HID device that can be opened. Without one it is
// an AutoDevice, and its `note` has the reason. Errors: an unknown name (lists the known ones), a recording that cannot
// be read, a device that cannot be opened.
MadeDevice open_device(const std::string& name, const DeviceRequest& request = {},
                       const std::vector<DeviceEntry>& entries = device_entries());

}  // namespace palpate
