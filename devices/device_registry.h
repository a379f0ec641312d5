// The devices by the names that --device takes.
// Thread guarantee: slow side.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "devices/hand_motion.h"
#include "engine/device.h"

namespace palpate {

struct DeviceDescription {
  std::string name;     // as --device takes it
  std::string summary;  // one line
  bool renders_force = false;
  std::string problem;  // why it cannot be opened here and what to do; empty: it can
};

// All there are, the default first.
std::vector<DeviceDescription> list_devices();

struct DeviceRequest {
  std::uint64_t seed = 1;  // of a hand that explores by itself
  HandSettings hand;       // how strongly a scene wants to be pressed
};

// Makes and opens the device of that name: auto, hand, mouse, replay:FILE. Errors:
// an unknown name (lists the known ones), a recording that cannot be read, a
// device that cannot be opened.
Result<std::unique_ptr<Device>> open_device(const std::string& name, const DeviceRequest& request = {});

}  // namespace palpate
