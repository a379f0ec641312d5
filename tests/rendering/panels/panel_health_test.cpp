// The status line of the panel in a session whose device is unplugged.
#include <gtest/gtest.h>

#include <filesystem>

#include "models/model/file/model_io.h"
#include "rendering/panels/panel_health.h"
#include "scenes/live/live_session.h"
#include "tests/support/example_model.h"
#include "tests/support/fake_device_bus.h"
#include "tests/support/session_frames.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::frames_until;

TEST(PanelHealth, KeepsTheWordsOfAnAlarmUntilTheyWereSeen) {
  const test::TemporaryFolder folder;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());  // fault files are written here
  const ModelData model = test::example_model("greedy", KernelKind::cubic, test::paper_features(), 1);
  ASSERT_TRUE(save_model(folder.file("m.json"), model, false).ok());
  test::FakeDeviceBus bus;
  SessionRequest request = test::session_request("skin", "hid", {folder.file("m.json")});
  request.bus = &bus;
  auto opened = LiveSession::open(request);
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  LiveSession& session = **opened;
  const auto unplugged = [&] { return (session.newest().device.faults & device_fault::kUnplugged) != 0; };
  ASSERT_TRUE(frames_until(session, [&] { return session.newest().device.zeroing == Zeroing::needed; }));
  bus.plugged_in = false;
  ASSERT_TRUE(frames_until(session, unplugged));
  const std::string words = device_fault_words(device_fault::kUnplugged).front();
  const HealthWords now = health_words(health_view(session), 0.0);
  EXPECT_EQ(now.text, "Device: " + words);
  EXPECT_TRUE(now.problem && !now.past);
  bus.plugged_in = true;
  // Until the device is zeroed the line has the reason; then it has the past fault.
  ASSERT_TRUE(frames_until(session, [&] { return bus.opened == 2; }));
  session.start_zeroing();
  ASSERT_TRUE(frames_until(session, [&] { return session.newest().device.faults == 0; }));
  const HealthWords later = health_words(health_view(session), 0.0);
  EXPECT_EQ(later.text.rfind("Earlier: " + words, 0), 0u) << later.text;
  EXPECT_TRUE(later.problem && later.past);
  // A slow machine may cause another alarm at once.
  EXPECT_TRUE(frames_until(
      session, [&] { return session.alarms().empty(); }, [&] { session.reset_figures(); }));
  EXPECT_FALSE(health_words(health_view(session), 0.0).past);
  opened->reset();
  std::filesystem::current_path(before);
}

}  // namespace
}  // namespace palpate
