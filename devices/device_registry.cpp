#include "devices/device_registry.h"

#include <string_view>
#include <utility>

#include "devices/auto_device.h"
#include "devices/hand_device.h"
#include "devices/mouse_device.h"
#include "devices/replay_device.h"

namespace palpate {
namespace {

using Made = Result<std::unique_ptr<Device>>;

constexpr std::string_view kReplay = "replay:";

Made make_auto(const std::string&, const DeviceRequest& request) {
  return Made(std::make_unique<AutoDevice>(request.seed, request.hand));
}

Made make_hand(const std::string&, const DeviceRequest& request) {
  return Made(std::make_unique<HandDevice>(request.seed, request.hand));
}

Made make_mouse(const std::string&, const DeviceRequest&) { return Made(std::make_unique<MouseDevice>()); }

Made make_replay(const std::string& path, const DeviceRequest&) {
  if (path.empty()) return Error{"--device replay: names no recording; write replay:FILE.csv"};
  Result<Recording> recording = read_recording(path);
  if (!recording) return recording.error();
  return Made(std::make_unique<ReplayDevice>(std::move(*recording)));
}

struct Entry {
  DeviceDescription description;
  Made (*make)(const std::string& path, const DeviceRequest& request);
};

// A new device is a line here.
const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = {
      {{"auto", "the simulated hand until the mouse takes over, and again after 20 s idle", true, ""}, make_auto},
      {{"hand", "a simulated hand that explores by itself and feels the force", true, ""}, make_hand},
      {{"mouse", "mouse or keyboard, coupled to the tool by a spring and a damper", true, ""}, make_mouse},
      {{"replay:FILE", "a recording at its own pace, over and over; its force is the reference", false, ""},
       make_replay},
  };
  return all;
}

std::string known_names() {
  std::string names;
  for (const Entry& entry : entries()) names += (names.empty() ? "" : ", ") + entry.description.name;
  return names;
}

}  // namespace

std::vector<DeviceDescription> list_devices() {
  std::vector<DeviceDescription> list;
  for (const Entry& entry : entries()) list.push_back(entry.description);
  list.push_back({"hid", "a haptic device on a USB port", true,
                  "not in this version of the program; use one of the devices above"});
  return list;
}

Result<std::unique_ptr<Device>> open_device(const std::string& name, const DeviceRequest& request) {
  const bool replay = name.rfind(kReplay, 0) == 0;
  for (const Entry& entry : entries()) {
    const bool chosen = replay ? entry.description.name.rfind(kReplay, 0) == 0 : entry.description.name == name;
    if (!chosen) continue;
    Made device = entry.make(replay ? name.substr(kReplay.size()) : "", request);
    if (!device) return device;
    if (const Status status = (*device)->open(); !status) return status.error();
    return device;
  }
  return Error{"unknown device \"" + name + "\", expected one of: " + known_names() + " (palpate devices explains)"};
}

}  // namespace palpate
