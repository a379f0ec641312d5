// The recorder writes every sample to a file that the reader accepts, whatever the device does.
#include "scenes/live/session_recorder.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <thread>

#include "devices/virtual/simulated_devices.h"
#include "tests/support/full_disk.h"
#include "tests/support/live_doubles.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::FakePacer;
using test::PathDevice;
using test::read_text;
using test::TemporaryFolder;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class DepthForce final : public ReferenceForce {
 public:
  double step(const TickSnapshot& snapshot, bool) noexcept override { return 250.0 * snapshot.depth_m; }
};

// A loop without its thread, whose first model is the recorded one.
struct Rig {
  explicit Rig(Device& device) : loop(device), recorder(loop) {
    auto models = std::make_unique<LiveModels>(1, device.sensor(), std::vector{test::spring(300.0)},
                                               std::make_shared<DepthForce>());
    models->written_model = 0;
    loop.publish_models(std::move(models));
  }
  Status start(const std::string& path, ReferenceKind force, RecordingColumns columns = {}) {
    Status status = recorder.start({path, force, columns, {"made by a test"}});
    loop.set_controls({1, 0, recorder.number()});
    return status;
  }
  void run(int ticks) {
    FakePacer pacer([&](int wait) -> std::int64_t {
      if (wait == ticks - 1) loop.request_stop();
      return 0;
    });
    loop.run(pacer);
  }
  // The notice of a recorder that ends by itself within two seconds.
  Notice outcome() {
    std::optional<Notice> said;
    for (int i = 0; i < 200 && !(said = recorder.read_outcome()); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return said.value_or(Notice{"no outcome", false});
  }
  Notice finish() {
    recorder.stop();
    recorder.wait();
    return recorder.read_outcome().value_or(Notice{"no outcome", true});
  }
  HapticsLoop loop;
  SessionRecorder recorder;
};

TEST(SessionRecorder, WritesEverySampleOfAHand) {
  const TemporaryFolder folder;
  HandDevice hand(1);
  Rig rig(hand);
  ASSERT_TRUE(rig.start(folder.file("hand.csv"), ReferenceKind::truth, {true, false}).ok());
  EXPECT_TRUE(rig.recorder.status().active);
  rig.run(20000);
  const Notice notice = rig.finish();
  EXPECT_FALSE(notice.problem) << notice.text;
  EXPECT_TRUE(test::has_parts(notice.text, {"20000 rows", "20.0 s", "hand.csv"}));
  EXPECT_FALSE(rig.recorder.status().active);
  const Recording recording = test::must(read_recording(folder.file("hand.csv")));
  ASSERT_EQ(recording.rows.size(), 20000u);
  EXPECT_TRUE(recording.columns.velocity);
  EXPECT_EQ(recording.rows.front().time_s, 0.0);
  double most_m = 0.0;
  for (std::size_t i = 0; i < recording.rows.size(); ++i) {
    const RecordingRow& row = recording.rows[i];
    ASSERT_EQ(row.force_N, 250.0 * std::max(0.0, row.position_m));
    if (i > 0) {
      ASSERT_NEAR(row.time_s - recording.rows[i - 1].time_s, 1e-3, 1e-9);
    }
    most_m = std::max(most_m, row.position_m);
  }
  EXPECT_GT(most_m, 1e-3) << "it pressed";
  EXPECT_EQ(read_text(folder.file("hand.csv")).rfind("# made by a test\n", 0), 0u);
}

TEST(SessionRecorder, OmitsSamplesThatTheLoopRefused) {
  const TemporaryFolder folder;
  PathDevice device([](double time_s) { return std::fmod(time_s, 0.1) < 0.005 ? kNan : 1e-3; });
  Rig rig(device);
  ASSERT_TRUE(rig.start(folder.file("a.csv"), ReferenceKind::truth).ok());
  rig.run(1000);
  const Notice notice = rig.finish();
  EXPECT_TRUE(test::has_parts(notice.text, {"left out"}));
  const Recording recording = test::must(read_recording(folder.file("a.csv")));
  EXPECT_NEAR(static_cast<double>(recording.rows.size()), 950.0, 12.0);
}

TEST(SessionRecorder, ReportsAMissingFolder) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.file("sub"));
  PathDevice device(test::strokes);
  Rig rig(device);
  ASSERT_TRUE(rig.start(folder.file("sub/a.csv"), ReferenceKind::truth).ok());
  rig.run(100);
  std::filesystem::remove_all(folder.file("sub"));
  const Notice notice = rig.finish();
  EXPECT_TRUE(notice.problem);
  EXPECT_TRUE(test::has_parts(notice.text, {folder.file("sub/a.csv")}));
  EXPECT_TRUE(folder.entries().empty());
}

// On a full disk a recording ends by itself. The rows on the disk stay, and the next recording may begin.
TEST(SessionRecorder, KeepsTheRowsOnTheDiskWhenItIsFull) {
  for (const bool flushed : {false, true}) {
    SCOPED_TRACE(flushed);
    const TemporaryFolder folder;
    const std::string part = folder.file("a.csv.part");
    PathDevice device(test::strokes);
    Rig rig(device);
    Notice notice;
    {
      const test::FullDisk full(100'000);
      ASSERT_TRUE(rig.start(folder.file("a.csv"), ReferenceKind::truth).ok());
      FakePacer pacer([&](int wait) -> std::int64_t {
        for (int i = 0; flushed && wait == 1500 && i < 200 && std::filesystem::file_size(part) == 0; ++i)
          std::this_thread::sleep_for(std::chrono::milliseconds(10));
        if (wait == 30000) rig.loop.request_stop();
        return 0;
      });
      rig.loop.run(pacer);
      notice = rig.outcome();
    }
    EXPECT_TRUE(notice.problem);
    EXPECT_TRUE(test::has_parts(notice.text, {"File too large"}));
    ASSERT_EQ(folder.entries().empty(), !flushed);
    EXPECT_TRUE(rig.start(folder.file("b.csv"), ReferenceKind::truth).ok());
    if (!flushed) continue;
    const auto kept = test::must(read_recording(part));
    EXPECT_TRUE(test::has_parts(notice.text, {part + " has its first " + std::to_string(kept.rows.size()) + " rows"}));
  }
}

// The threads of the loop and of the recorder run in parallel, for the thread sanitizer.
TEST(SessionRecorder, RecordsBesideTheRunningLoop) {
  const TemporaryFolder folder;
  PathDevice device(test::strokes);
  LoopSettings settings;
  settings.realtime = false;
  HapticsLoop loop(device, settings);
  SessionRecorder recorder(loop);
  loop.publish_models(std::make_unique<LiveModels>(1, device.sensor(), std::vector{test::spring(300.0)},
                                                   std::make_shared<DepthForce>()));
  ASSERT_TRUE(loop.start().ok());
  for (const char* name : {"a.csv", "b.csv"}) {
    ASSERT_TRUE(recorder.start({folder.file(name), ReferenceKind::truth, {}, {}}).ok());
    loop.set_controls({1, 0, recorder.number()});
    while (recorder.status().rows < 100) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    loop.set_controls({1, 0, 0});
    recorder.stop();
    recorder.wait();
    const std::optional<Notice> outcome = recorder.read_outcome();
    ASSERT_TRUE(outcome.has_value());
    EXPECT_FALSE(outcome->problem) << outcome->text;
    EXPECT_GE(read_recording(folder.file(name)).value().rows.size(), 100u);
  }
}

TEST(RecordingTime, IsStrictlyIncreasing) {
  RecordingTime time;
  EXPECT_EQ(time.file_time_s(1000.0, true), 0.0);
  EXPECT_EQ(time.file_time_s(1000.5, false), 0.5);
  EXPECT_EQ(time.file_time_s(1000.5, false), std::nullopt);
  EXPECT_EQ(time.file_time_s(999.0, false), std::nullopt);
  EXPECT_EQ(time.file_time_s(7.0, true), 0.5 + kStreamGap_s);
  EXPECT_EQ(time.file_time_s(7.25, false), 0.75 + kStreamGap_s);
  EXPECT_EQ(time.last_s() - time.gaps_s(), 0.75);
}

}  // namespace
}  // namespace palpate
