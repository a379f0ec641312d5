// palpate devices: which devices there are, and why one cannot be opened.
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "devices/device_registry.h"
#include "scenes/cli/verbs.h"

namespace palpate::cli {
namespace {

Status print_devices() {
  const std::vector<DeviceDescription> devices = list_devices();
  std::size_t width = 0;
  for (const DeviceDescription& device : devices) width = std::max(width, device.name.size());
  const int column = static_cast<int>(width);
  std::printf("%-*s  %-5s  %-6s  %s\n", column, "DEVICE", "FORCE", "USABLE", "WHAT IT IS");
  for (const DeviceDescription& device : devices) {
    std::printf("%-*s  %-5s  %-6s  %s\n", column, device.name.c_str(), device.renders_force ? "yes" : "no",
                device.problem.empty() ? "yes" : "no", device.summary.c_str());
    if (!device.problem.empty()) std::printf("%*s  %s\n", column + 15, "", device.problem.c_str());
  }
  return {};
}

}  // namespace

void add_devices(CLI::App& app, Verbs& verbs) {
  CLI::App* command = app.add_subcommand("devices", "List the devices and say why one cannot be opened");
  verbs.emplace_back(command, print_devices);
}

}  // namespace palpate::cli
