// palpate devices and palpate scenes: list what there is, and why a device cannot be opened.
#include <cstdio>
#include <string_view>

#include "devices/bridge/bridge_bus.h"
#include "devices/hid/hidapi_bus.h"
#include "devices/link/device_link.h"
#include "devices/registry/device_registry.h"
#include "scenes/cli/verbs.h"

namespace palpate::cli {

std::string plugged_in_text(DeviceBus& bus, const std::string& assets) {
  std::string text = "\nPLUGGED IN (hidraw)\n";
  const std::vector<DeviceNode> nodes = bus.list();
  if (nodes.empty()) text += "  none; a haptic device appears here when it is plugged in\n";
  bool problems = false;
  for (const DeviceNode& node : nodes) {
    const DeviceProtocol* const protocol = hid_protocol_of(node);
    char ids[16];
    std::snprintf(ids, sizeof ids, "%04x:%04x", node.vendor_id, node.product_id);
    text += "  " + (node.path.empty() ? "(no node)" : node.path) + "  " + ids + "  " + node.product + ": " +
            (protocol != nullptr ? protocol->description : "not supported") + "\n";
    if (protocol == nullptr) continue;
    const auto opened = bus.open(node);
    if (opened) continue;
    problems = true;
    text += "    cannot be used: " + opened.error().message + "\n";
  }
  if (problems) {
    text += "\nInstall the udev rule once: sudo cp " + assets +
            "/udev/70-palpate.rules /etc/udev/rules.d/ && sudo udevadm control --reload && sudo udevadm trigger\n";
  }
  return text;
}

namespace {

Status print_devices() {
  const Result<std::string> assets = find_assets();
  std::vector<std::vector<std::string>> rows = {{"DEVICE", "FORCE", "USABLE", "DESCRIPTION"}};
  for (const DeviceDescription& device : list_devices({.calibrations = calibrations_folder()})) {
    // What an error of another verb says of this one is left out here.
    const std::string problem = device.problem.substr(0, device.problem.find(" (palpate devices"));
    rows.push_back(
        {device.name, device.holder != Holder::none ? "yes" : "no", problem.empty() ? "yes" : "no", device.summary});
    if (!problem.empty()) rows.push_back({"", "", "", problem});
  }
  print_table(rows, false);
  std::printf("\nSUPPORTED BY hid\n");
  for (const DeviceProtocol* protocol : kHidProtocols)
    std::printf("  %s: %s; tested %s\n", protocol->name, protocol->description, kTestedOn);
  std::fputs(plugged_in_text(system_hid_bus(), assets ? *assets : "assets").c_str(), stdout);
  return {};
}

struct DevicesOptions {
  std::string test;
  bool bridge_remote = false;
};

Status run_devices(const DevicesOptions& options) {
  constexpr std::string_view kBridge = "bridge:";
  if (options.test.empty()) return print_devices();
  if (options.test.rfind(kBridge, 0) != 0)
    throw CLI::ValidationError("--test", "found \"" + options.test + "\", expected bridge:TARGET");
  if (options.bridge_remote) allow_remote_bridges();
  const auto result = test_bridge(options.test.substr(kBridge.size()));
  if (!result) return result.error();
  std::printf("%s", result->c_str());
  return {};
}

Status list_scenes() {
  const Result<std::vector<std::string>> names = scene_names();
  if (!names) return names.error();
  std::vector<std::vector<std::string>> rows = {{"SCENE", "TITLE", "MATERIAL", "FEATURES"}};
  for (const std::string& name : *names) {
    const Result<Scene> scene = load_scene(name);
    if (!scene) return scene.error();
    rows.push_back({name, scene->title, scene->material.value_or("-"), describe_features(*scene)});
  }
  print_table(rows, false);
  return {};
}

}  // namespace

void add_devices(CLI::App& app, Verbs& verbs) {
  auto options = std::make_shared<DevicesOptions>();
  CLI::App* command = app.add_subcommand("devices", "List the devices and say why one cannot be opened");
  command->add_option("--test", options->test, "Test the watchdog of a bridge device with a force of 0 N")
      ->type_name("bridge:TARGET");
  command->add_flag("--bridge-remote", options->bridge_remote, "Allow bridge:tcp: to name another computer");
  verbs.emplace_back(command, [options] { return run_devices(*options); });
}

void add_scenes(CLI::App& app, Verbs& verbs) {
  verbs.emplace_back(app.add_subcommand("scenes", "List the scenes"), list_scenes);
}

}  // namespace palpate::cli
