#include "devices/registry/device_registry.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "devices/firmware/wire.h"
#include "devices/hid/hidapi_bus.h"
#include "engine/live/live_tick.h"
#include "tests/support/example_model.h"
#include "tests/support/fake_device_bus.h"
#include "tests/support/live_doubles.h"
#include "tests/support/message_parts.h"
#include "tests/support/own_device.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

// Opening devices by name; a new device of three files.

// Only the devices on `bus` are present.
DeviceRequest request_with(DeviceBus& bus) {
  DeviceRequest request;
  request.bus = &bus;
  request.calibrations = std::string(PALPATE_SOURCE_DIR) + "/assets/devices";
  return request;
}

test::FakeDeviceBus& nothing_plugged_in() {
  static test::FakeDeviceBus bus;
  bus.plugged_in = false;
  return bus;
}

TEST(DeviceRegistry, OpensEveryDeviceThatItListsAsUsable) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("press.csv");
  ASSERT_TRUE(write_recording(path, test::example_recording(100, 1000.0), {}, false).ok());
  const DeviceRequest request = request_with(nothing_plugged_in());
  for (const DeviceDescription& description : list_devices(request)) {
    const bool replay = description.name == "replay:FILE";
    if (description.name == "bridge:TARGET") continue;  // tests/devices/bridge
    auto device = open_device(replay ? "replay:" + path : description.name, request);
    ASSERT_EQ(device.ok(), description.problem.empty()) << description.name;
    if (!device) continue;
    EXPECT_EQ((*device)->name(), replay ? "replay:press" : description.name);
    EXPECT_EQ((*device)->holder(), description.holder) << description.name;
    DeviceSample sample;
    EXPECT_TRUE((*device)->read(1.0, sample)) << description.name;
    (*device)->close();
  }
  EXPECT_EQ(list_devices(request).front().name, "auto");
}

TEST(DeviceRegistry, AutoPrefersAHapticDevice) {
  test::FakeDeviceBus bus;
  Result device = test::must(open_device("auto", request_with(bus)));
  EXPECT_EQ((*device)->name(), "hid");
  EXPECT_TRUE(test::has_parts((*device)->note(), {"OpenFFBoard", "FFBoard", "/dev/hidraw7"}));
  EXPECT_EQ((*device)->limits().largest_N, 5.0);
  EXPECT_FALSE((*device)->health(0.0).may_push()) << "not zeroed";
  for (const DeviceDescription& description : list_devices(request_with(bus))) EXPECT_EQ(description.problem, "");
}

// A bus on which every device is refused, and one with a SpaceMouse.
struct OtherBuses {
  OtherBuses() {
    refused.refusals = 1000;
    mouse.silent = true;
  }
  test::FakeDeviceBus refused, mouse{test::found_space_mouse()};
};

TEST(DeviceRegistry, AutoNotesTheFallbackAndItsReason) {
  OtherBuses buses;
  test::FakeDeviceBus board;
  DeviceRequest without_calibrations;
  without_calibrations.bus = &board;
  const std::pair<DeviceRequest, std::vector<std::string>> notes[] = {
      {request_with(nothing_plugged_in()), {"simulated hand", "mouse"}},
      {request_with(buses.refused), {"/dev/hidraw7", "permission", "simulated hand"}},
      {request_with(buses.mouse), {"simulated hand", "mouse", "SpaceMouse"}},
      {without_calibrations, {"PALPATE_ASSETS", "simulated hand"}}};
  for (const auto& [request, parts] : notes) {
    Result device = test::must(open_device("auto", request));
    EXPECT_EQ((*device)->name(), "auto");
    EXPECT_TRUE(test::has_parts((*device)->note(), parts));
  }
}

TEST(DeviceRegistry, ErrorsHaveAdvice) {
  EXPECT_TRUE(
      test::has_parts(open_device("joystick").error().message, {"\"joystick\"", "FILE", "TARGET", "palpate devices"}));
  EXPECT_TRUE(test::has_parts(open_device("replay:").error().message, {"--device", "FILE.csv"}));
  EXPECT_EQ(open_device("replay:/nowhere.csv").error().message.rfind("/nowhere.csv", 0), 0u);
}

// The third file of a new device is the table of devices, with a new row. These tests use their own table.
const std::vector<DeviceEntry>& entries() {
  static const std::vector<DeviceEntry> all = {
      {{"own:MM", "a device of three files", Holder::person, ""}, test::make_own_device}};
  return all;
}

TEST(OwnDevice, IsOpenedByItsNameAndRenderedOn) {
  Result device = test::must(open_device("own:4", {}, entries()));
  ModelSlot<LiveModels> slot;
  LiveTick live(**device, slot);
  slot.publish(std::make_unique<LiveModels>(1, (*device)->sensor(), std::vector{test::spring(500.0)}));
  double largest_N = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const LoopSnapshot& snapshot = live.run(1e-3 * i, {});
    ASSERT_EQ(snapshot.faults & loop_fault::kStops, 0u) << i;
    largest_N = std::max(largest_N, static_cast<test::OwnDevice&>(**device).force_N());
  }
  EXPECT_NEAR(largest_N, 2.0, 0.02);
}

TEST(OwnDevice, HasTheErrorsOfAnyOther) {
  EXPECT_FALSE(open_device("own:no", {}, entries()).ok());
  const auto unknown = open_device("mouse", {}, entries());
  ASSERT_FALSE(unknown.ok());
  EXPECT_TRUE(test::has_parts(unknown.error().message, {"own:MM"}));
}

// The cap of a SpaceMouse as a tool.

DeviceCalibration calibration() {
  DeviceCalibration result;
  result.protocol = &kSpaceMouseProtocol;
  result.counts_per_metre = 17500.0;
  result.rest_position_m = -0.006;
  return result;
}

// A device with a SpaceMouse, whose reports the test makes in simulated time.
struct Moved {
  void report(int counts, double now_s) {
    std::uint8_t bytes[7] = {1};
    wire::write16(bytes + 5, static_cast<std::uint16_t>(counts));
    tool.report_arrived(bytes, sizeof bytes, now_s);
  }

  test::FakeDeviceBus bus{test::found_space_mouse()};
  AutoDevice tool{bus, calibration(), std::move(*open_first(bus, {&kSpaceMouseProtocol}))};
};

// A cap that moves evenly, reported every 16 ms: the tool moves at every tick of 1 ms, about equally far.
TEST(SpaceMouse, MovesAtEveryTickBetweenReports) {
  Moved moved;
  DeviceSample sample;
  double last_m = -0.006, largest_m = 0.0;
  int standing = 0;
  for (int ms = 0; ms <= 480; ++ms) {
    const double now_s = 1e-3 * ms;
    if (ms % 16 == 0) moved.report(300 * ms / 480, now_s);
    ASSERT_TRUE(moved.tool.MouseDevice::read(now_s, sample));
    if (ms > 150) {
      largest_m = std::max(largest_m, sample.tool.position_m - last_m);
      standing += sample.tool.position_m <= last_m ? 1 : 0;
    }
    last_m = sample.tool.position_m;
  }
  const double per_tick_m = 300.0 / 480.0 / 17500.0;
  EXPECT_LT(largest_m, 1.2 * per_tick_m) << "without the low-pass filter it would be 16 ticks' worth";
  EXPECT_EQ(standing, 0);
}

// Reads `device` about every millisecond, in real time.
template <typename Done>
bool read_until(Device& device, DeviceSample& sample, Done done) {
  for (int i = 0; i < 5000 && !done(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    device.read(1.0 + 1e-3 * i, sample);
  }
  return done();
}

TEST(SpaceMouse, TakesOverFromTheHandInAuto) {
  test::FakeDeviceBus bus{test::found_space_mouse()};
  bus.report = {1, 0, 0, 0, 0, 0x2C, 0x01};  // the cap is pushed by 300 counts
  AutoDevice device(bus, calibration(), std::move(*open_first(bus, {&kSpaceMouseProtocol})));
  EXPECT_EQ(device.holder(), Holder::simulated);
  DeviceSample sample;
  for (int ms = 0; ms < 5; ++ms) device.read(1e-3 * ms, sample);
  EXPECT_TRUE(device.hand_is_exploring());
  ASSERT_TRUE(device.open().ok());
  EXPECT_TRUE(read_until(device, sample, [&] { return !device.hand_is_exploring(); }));
  EXPECT_TRUE(read_until(device, sample, [&] { return sample.tool.position_m > 5e-3; }));
  device.close();
  EXPECT_EQ(bus.writes, 0);
}

}  // namespace
}  // namespace palpate
