#include "devices/registry/device_registry.h"

#include "devices/bridge/bridge_bus.h"
#include "devices/hid/hidapi_bus.h"
#include "engine/base/text.h"

namespace palpate {
namespace {

// Opens the first HID device that renders forces, or does not, and makes a `T` of it with its calibration and `further`
// arguments. Null: none is plugged in.
template <typename T, typename... Further>
MadeDevice make_hid_device(const DeviceRequest& request, bool renders_force, const Further&... further) {
  DeviceBus& bus = request.bus != nullptr ? *request.bus : system_hid_bus();
  std::vector<const DeviceProtocol*> protocols(kHidProtocols.begin(), kHidProtocols.end());
  std::erase_if(protocols, [&](const DeviceProtocol* one) { return one->renders_force != renders_force; });
  Result<OpenedDevice> opened = open_first(bus, protocols);
  if (!opened) return opened.error();
  if (opened->connection == nullptr) return std::unique_ptr<Device>();
  const Result<DeviceCalibration> calibration = read_calibration(request.calibrations, *opened->protocol);
  if (!calibration) return calibration.error();
  return MadeDevice(std::make_unique<T>(bus, *calibration, std::move(*opened), further...));
}

MadeDevice make_hid(const std::string&, const DeviceRequest& request) {
  MadeDevice haptic = make_hid_device<LinkedDevice>(request, true);
  if (!haptic || *haptic != nullptr) return haptic;
  return Error{
      "no haptic device is plugged in; plug one in or use --device auto, which a SpaceMouse can move "
      "(palpate devices explains)"};
}

MadeDevice make_auto(const std::string&, const DeviceRequest& request) {
  MadeDevice haptic = make_hid_device<LinkedDevice>(request, true);
  if (haptic && *haptic != nullptr) return haptic;
  std::string note = haptic ? "no haptic device is plugged in" : haptic.error().message;
  MadeDevice with_space_mouse = make_hid_device<AutoDevice>(
      request, false, request.seed, request.hand,
      note + ": a simulated hand moves until the mouse or the SpaceMouse (no force) takes over");
  if (with_space_mouse && *with_space_mouse != nullptr) return with_space_mouse;
  if (!with_space_mouse) note += "; " + with_space_mouse.error().message;
  note += ": a simulated hand moves until the mouse takes over";
  return MadeDevice(std::make_unique<AutoDevice>(request.seed, request.hand, std::move(note)));
}

MadeDevice make_replay(const std::string& path, const DeviceRequest&) {
  if (path.empty()) return Error{"--device replay: names no recording; write replay:FILE.csv"};
  Result<Recording> recording = read_recording(path);
  if (!recording) return recording.error();
  return MadeDevice(std::make_unique<ReplayDevice>(std::move(*recording)));
}

MadeDevice make_bridge(const std::string& target, const DeviceRequest& request) {
  const Result<DeviceCalibration> calibration = read_calibration(request.calibrations, kBridgeProtocol);
  if (!calibration) return calibration.error();
  auto bus = std::make_unique<BridgeBus>(target);
  Result<OpenedDevice> opened = bus->open_and_identify();
  if (!opened) return opened.error();
  BridgeBus& used = *bus;
  return MadeDevice(std::make_unique<LinkedDevice>(used, *calibration, std::move(*opened), "bridge", std::move(bus)));
}

}  // namespace

const std::vector<DeviceEntry>& device_entries() {
  static const std::vector<DeviceEntry> all = {
      {{"auto", "a haptic device if there is one, otherwise a simulated hand until the mouse takes over",
        Holder::simulated, ""},
       make_auto},
      {{"hand", "a simulated hand that moves by itself and yields to the force", Holder::simulated, ""},
       [](const std::string&, const DeviceRequest& request) {
         return MadeDevice(std::make_unique<HandDevice>(request.seed, request.hand));
       }},
      {{"mouse", "mouse or keyboard, coupled to the tool by a spring and a damper", Holder::simulated, ""},
       [](const std::string&, const DeviceRequest&) { return MadeDevice(std::make_unique<MouseDevice>()); }},
      {{"hid", "a haptic device on a USB port", Holder::person, ""}, make_hid},
      {{"replay:FILE", "a recording, repeated at its own speed; its force is the reference", Holder::none, ""},
       make_replay},
      {{"bridge:TARGET", "a device with the bridge protocol: /dev/TTY[,BAUD], unix:PATH, tcp:HOST:PORT, exec:COMMAND",
        Holder::person, ""},
       make_bridge},
  };
  return all;
}

std::vector<DeviceDescription> list_devices(const DeviceRequest& request) {
  std::vector<DeviceDescription> list;
  for (const DeviceEntry& entry : device_entries()) {
    list.push_back(entry.description);
    if (entry.make != make_hid) continue;
    if (const MadeDevice hid = make_hid("", request); !hid) list.back().problem = hid.error().message;
  }
  return list;
}

MadeDevice open_device(const std::string& name, const DeviceRequest& request, const std::vector<DeviceEntry>& entries) {
  // Some names have an argument after a colon.
  const std::size_t colon = name.find(':');
  const std::string what = colon == std::string::npos ? "" : name.substr(colon + 1);
  std::vector<std::string> names;
  for (const DeviceEntry& entry : entries) {
    const std::string& known = names.emplace_back(entry.description.name);
    const std::size_t end = known.find(':');
    if (name.substr(0, colon) != known.substr(0, end) || (colon == std::string::npos) != (end == std::string::npos))
      continue;
    MadeDevice device = entry.make(what, request);
    if (!device) return device;
    if (const Status status = (*device)->open(); !status) return status.error();
    return device;
  }
  return Error{"unknown device \"" + printable(name) + "\", expected one of: " + joined(names) +
               " (palpate devices explains)"};
}

}  // namespace palpate
