// palpate devices: which devices there are, and why one cannot be opened.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "devices/registry/device_registry.h"
#include "devices/hid/hidapi_bus.h"
#include "scenes/scene/assets.h"
#include "scenes/cli/verbs.h"

namespace palpate::cli {
namespace {

void print_plugged_in(const std::vector<HidDiagnosis>& all, const std::string& assets) {
  std::printf("\nPLUGGED IN (hidraw)\n");
  if (all.empty()) std::printf("  nothing; a haptic device shows up here as soon as it is plugged in\n");
  bool problems = false;
  for (const HidDiagnosis& one : all) {
    std::printf("  %s  %04x:%04x  %s: %s\n", one.info.path.empty() ? "(no node)" : one.info.path.c_str(),
                one.info.vendor_id, one.info.product_id, one.info.product.c_str(), one.use.c_str());
    if (one.problem.empty()) continue;
    problems = true;
    std::printf("    cannot be used: %s\n", one.problem.c_str());
  }
  if (!problems) return;
  std::printf("\nThe udev rule, once: sudo cp %s/udev/70-palpate.rules /etc/udev/rules.d/ && sudo udevadm control "
              "--reload && sudo udevadm trigger\n", assets.c_str());
}

Status print_devices() {
  DeviceRequest request;
  std::string assets = "assets";
  if (const Result<std::string> found = find_assets(); found) {
    assets = *found;
    request.calibrations = assets + "/devices";
  }
  const std::vector<HidDiagnosis> plugged_in = diagnose(system_hid_bus());
  const std::vector<DeviceDescription> devices = list_devices(request);
  std::size_t width = 0;
  for (const DeviceDescription& device : devices) width = std::max(width, device.name.size());
  const int column = static_cast<int>(width);
  std::printf("%-*s  %-5s  %-6s  %s\n", column, "DEVICE", "FORCE", "USABLE", "WHAT IT IS");
  for (const DeviceDescription& device : devices) {
    std::printf("%-*s  %-5s  %-6s  %s\n", column, device.name.c_str(), device.renders_force ? "yes" : "no",
                device.problem.empty() ? "yes" : "no", device.summary.c_str());
    if (!device.problem.empty()) std::printf("%*s  %s\n", column + 15, "", device.problem.c_str());
  }
  print_plugged_in(plugged_in, assets);
  return {};
}

}  // namespace

void add_devices(CLI::App& app, Verbs& verbs) {
  CLI::App* command = app.add_subcommand("devices", "List the devices and say why one cannot be opened");
  verbs.emplace_back(command, print_devices);
}

}  // namespace palpate::cli
