// The devices by the names that --device takes.
// Thread guarantee: slow side.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "devices/link/device_bus.h"
#include "devices/virtual/hand_motion.h"
#include "engine/live/device.h"

namespace palpate {

struct DeviceDescription {
  std::string name;     // as --device takes it
  std::string summary;  // one line
  Holder holder = Holder::none;
  std::string problem;  // why it cannot be opened here and what to do; empty: it can
};

struct DeviceRequest {
  std::uint64_t seed = 1;  // of a hand that explores by itself
  HandSettings hand;       // how strongly a scene wants to be pressed
  // Where the calibrations of HID devices are: assets/devices. Without it no HID
  // device can be used, and "auto" says so.
  std::string calibrations;
  DeviceBus* bus = nullptr;  // null: the machine's own
};

// What makes a device: `what` stands behind the colon of its name.
using MadeDevice = Result<std::unique_ptr<Device>>;
struct DeviceEntry {
  DeviceDescription description;
  MadeDevice (*make)(const std::string& what, const DeviceRequest& request);
};
// All there are, the default first. A new device is a line of this table.
const std::vector<DeviceEntry>& device_entries();

// Those of the table. Opens and closes HID devices to see whether
// they can be used; takes half a second when one cannot.
std::vector<DeviceDescription> list_devices(const DeviceRequest& request = {});

// Makes and opens the device of that name: auto, hand, mouse, hid,
// replay:FILE, bridge:TARGET.
// "auto" is the haptic device that can be opened; without one the simulated hand
// until the mouse or a SpaceMouse takes over, and its `note` says why. Errors: an
// unknown name (lists the known ones), a recording that cannot be read, a device
// that cannot be opened.
MadeDevice open_device(const std::string& name, const DeviceRequest& request = {},
                       const std::vector<DeviceEntry>& entries = device_entries());

}  // namespace palpate
