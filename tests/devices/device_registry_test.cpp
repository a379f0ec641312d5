// Devices by name.
#include "devices/device_registry.h"

#include <gtest/gtest.h>

#include "tests/support/example_model.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

TEST(DeviceRegistry, OpensEveryDeviceThatItListsAsUsable) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("press.csv");
  ASSERT_TRUE(write_recording(path, test::example_recording(100, 1000.0), {}, false).ok());
  for (const DeviceDescription& description : list_devices()) {
    const bool replay = description.name == "replay:FILE";
    auto device = open_device(replay ? "replay:" + path : description.name);
    ASSERT_EQ(device.ok(), description.problem.empty()) << description.name;
    if (!device) continue;
    EXPECT_EQ((*device)->name(), replay ? "replay:press" : description.name);
    EXPECT_EQ((*device)->renders_force(), description.renders_force) << description.name;
    DeviceSample sample;
    EXPECT_TRUE((*device)->read(1.0, sample)) << description.name;
    (*device)->close();
  }
  EXPECT_EQ(list_devices().front().name, "auto");
}

TEST(DeviceRegistry, ExplainsWhatItCannotOpen) {
  EXPECT_EQ(open_device("joystick").error().message,
            "unknown device \"joystick\", expected one of: auto, hand, mouse, replay:FILE (palpate devices explains)");
  EXPECT_EQ(open_device("replay:").error().message,
            "--device replay: names no recording; write replay:FILE.csv");
  EXPECT_EQ(open_device("replay:/nowhere.csv").error().message.rfind("/nowhere.csv", 0), 0u);
}

TEST(DeviceRegistry, TheProgramListsThem) {
  const auto run = test::run_palpate({"devices"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.err, "");
  for (const DeviceDescription& description : list_devices()) {
    EXPECT_NE(run.out.find(description.name), std::string::npos) << run.out;
    EXPECT_NE(run.out.find(description.problem), std::string::npos) << run.out;
  }
}

}  // namespace
}  // namespace palpate
