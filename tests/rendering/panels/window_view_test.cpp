// The contents of a frame of real sessions, without a window.
#include "rendering/panels/window_view.h"

#include <gtest/gtest.h>

#include "models/model/file/model_io.h"
#include "tests/support/example_model.h"
#include "tests/support/fake_device_bus.h"
#include "tests/support/session_frames.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::frames_until;

std::unique_ptr<LiveSession> open_session(const test::TemporaryFolder& folder, const std::string& device,
                                          DeviceBus* bus) {
  const ModelData model = test::example_model("greedy", KernelKind::cubic, test::paper_features(), 1);
  EXPECT_TRUE(save_model(folder.file("m.json"), model, false).ok());
  SessionRequest request = test::session_request("skin", device, {folder.file("m.json")});
  request.bus = bus;
  request.data_folder = folder.path();
  auto session = LiveSession::open(request);
  EXPECT_TRUE(session.ok()) << session.error().message;
  return std::move(*session);
}

TEST(WindowView, HasTheFaultsOfTheDeviceAndTheAlarmsAfterThem) {
  const test::TemporaryFolder folder;
  test::FakeDeviceBus bus;
  const auto session = open_session(folder, "hid", &bus);
  ASSERT_TRUE(frames_until(*session, [&] { return session->newest().device.zeroing == Zeroing::needed; }));
  bus.plugged_in = false;
  ASSERT_TRUE(
      frames_until(*session, [&] { return (session->newest().device.faults & device_fault::kUnplugged) != 0; }));
  const HealthView health = window_view(*session, {}).health;
  const std::string words = device_fault_words(device_fault::kUnplugged).front();
  EXPECT_EQ(health.device_name, session->device_name());
  EXPECT_NE(health.newest.device.faults & device_fault::kUnplugged, 0u);
  EXPECT_FALSE(health.faults.empty());
  ASSERT_FALSE(health.alarms.empty());
  EXPECT_EQ(health.alarms.front(), words);
  EXPECT_GT(health.loop.ticks, 0u);
}

// A replay that is paused gives no new ticks.
TEST(WindowView, APausedReplayShowsANewModelAndItsCurvesStand) {
  const test::TemporaryFolder folder;
  const Recording recording = test::example_recording(700, 1000.0, 30e-6);
  ASSERT_TRUE(write_recording(folder.file("played.csv"), recording, {}, false).ok());
  const auto session = open_session(folder, "replay:" + folder.file("played.csv"), nullptr);
  ASSERT_TRUE(frames_until(*session, [&] {
    const TickSnapshot& newest = session->newest().tick;
    return session->models().all_settled() && newest.depth_m > 1e-3 && newest.model_count == 1;
  }));
  session->replay()->pause(true);
  ASSERT_TRUE(frames_until(*session, [&] { return session->newest().samples == 0; }));
  const ModelData direct = test::example_model("direct", KernelKind::cubic, test::maxwell_features(), 2);
  ASSERT_TRUE(save_model(folder.file("d.json"), direct, false).ok());
  ASSERT_TRUE(session->models().load_file(folder.file("d.json")));
  ASSERT_TRUE(frames_until(*session, [&] { return session->newest().tick.model_count == 2; }));
  const TickSnapshot& tick = session->newest().tick;
  ASSERT_GT(tick.force_N[1], 0.0);
  const HistoryPoint now = window_view(*session, {}).models.now;
  EXPECT_EQ(now.force_N[1], static_cast<float>(tick.force_N[1]));
  EXPECT_EQ(now.reference_N, static_cast<float>(session->newest().measured_N));
  const double stands_s = window_view(*session, {}).now_s;
  for (int i = 0; i < 5; ++i) session->update();
  EXPECT_EQ(window_view(*session, {}).now_s, stands_s);
  session->replay()->pause(false);
  ASSERT_TRUE(frames_until(*session, [&] { return window_view(*session, {}).now_s > stands_s; }));
}

}  // namespace
}  // namespace palpate
