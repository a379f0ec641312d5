// The devices by the names that --device takes.
// Thread guarantee: slow side.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "devices/hid/hid_bus.h"
#include "devices/virtual/hand_motion.h"
#include "engine/live/device.h"

namespace palpate {

struct DeviceDescription {
  std::string name;     // as --device takes it
  std::string summary;  // one line
  bool renders_force = false;
  std::string problem;  // why it cannot be opened here and what to do; empty: it can
};

struct DeviceRequest {
  std::uint64_t seed = 1;  // of a hand that explores by itself
  HandSettings hand;       // how strongly a scene wants to be pressed
  // Where the calibrations of HID devices are: assets/devices. Without it no HID
  // device can be used, and "auto" says so.
  std::string calibrations;
  HidBus* bus = nullptr;  // null: the machine's own
};

// All there are, the default first. Opens and closes HID devices to see whether
// they can be used; takes half a second when one cannot.
std::vector<DeviceDescription> list_devices(const DeviceRequest& request = {});

// Makes and opens the device of that name: auto, hand, mouse, hid,
// replay:FILE, bridge:TARGET.
// "auto" is the haptic device that can be opened; without one the simulated hand
// until the mouse or a SpaceMouse takes over, and its `note` says why. Errors: an
// unknown name (lists the known ones), a recording that cannot be read, a device
// that cannot be opened.
Result<std::unique_ptr<Device>> open_device(const std::string& name, const DeviceRequest& request = {});

// Whether a person at this device feels its force: a mouse and a hand that moves by
// itself take a force as well, but nobody feels it. Pure.
bool is_felt(Device& device) noexcept;

}  // namespace palpate
