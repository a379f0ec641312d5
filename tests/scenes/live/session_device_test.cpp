// A whole session with an OpenFFBoard on a fake bus, in real time. The device is
// unplugged during a press.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>

#include "engine/recording/recording.h"
#include "models/model/file/model_io.h"
#include "scenes/live/live_session.h"
#include "tests/support/example_model.h"
#include "tests/support/fake_device_bus.h"
#include "tests/support/message_parts.h"
#include "tests/support/session_frames.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

constexpr double kCounts_per_m = 20000.0;
constexpr double kRestPosition_m = -0.02;
constexpr int kStep = 20;  // counts per frame, 1 mm: slower than a jump fault

// The assets with a calibration that tolerates a slow machine.
void write_assets(const test::TemporaryFolder& folder) {
  const std::string assets = std::string(PALPATE_SOURCE_DIR) + "/assets";
  fs::create_directories(folder.file("assets/devices"));
  fs::create_directory_symlink(assets + "/scenes", folder.file("assets/scenes"));
  std::string text = test::read_text(assets + "/devices/openffboard.json");
  text = test::replaced(text, "\"stuck_after_s\": 0.5", "\"stuck_after_s\": 60");
  text = test::replaced(text, "\"ramp_s\": 0.5", "\"ramp_s\": 0.05");
  folder.with_file("assets/devices/openffboard.json", text);
}

class SessionDevice : public ::testing::Test {
 protected:
  void SetUp() override {
    // Fault files are written to the working directory.
    fs::current_path(folder_.path());
    write_assets(folder_);
    setenv("PALPATE_ASSETS", folder_.file("assets").c_str(), 1);
    // Where no true force is known, the first of two models is the reference of a recording.
    ModelData data = test::example_model("direct", KernelKind::cubic, test::paper_features(), 1);
    ASSERT_TRUE(save_model(folder_.file("model.json"), data, false).ok());
    const ModelData other = test::example_model("voxel", KernelKind::cubic, test::paper_features(), 2);
    ASSERT_TRUE(save_model(folder_.file("other.json"), other, false).ok());
    SessionRequest request =
        test::session_request("skin", "hid", {folder_.file("model.json"), folder_.file("other.json")});
    request.bus = &bus_;
    session_ = test::must(LiveSession::open(request));
    ASSERT_TRUE(frames_until([&] { return session_->models().all_settled(); }));
  }
  void TearDown() override {
    session_.reset();
    fs::current_path(before_);
    unsetenv("PALPATE_ASSETS");
  }

  // Runs frames until `done` while the tool moves to `target_`.
  bool frames_until(const std::function<bool()>& done) {
    return test::frames_until(*session_, done, [&] {
      bus_.counts += std::clamp(target_ - bus_.counts, -kStep, kStep);
      for (Notice& notice : session_->read_notices()) notices_.push_back(std::move(notice));
    });
  }

  bool zeroed() const { return session_->newest().device.zeroing == Zeroing::done; }
  void move_to(double position_m) {
    target_ = static_cast<int>(std::lround((position_m - kRestPosition_m) * kCounts_per_m));
  }
  const Notice* notice_with(const std::string& words) const {
    const auto found = std::find_if(notices_.begin(), notices_.end(),
                                    [&](const Notice& notice) { return notice.text.find(words) != std::string::npos; });
    return found == notices_.end() ? nullptr : &*found;
  }

  test::TemporaryFolder folder_;
  fs::path before_ = fs::current_path();
  std::vector<Notice> notices_;
  test::FakeDeviceBus bus_;
  int target_ = 0;  // counts to move to
  std::unique_ptr<LiveSession> session_;
};

TEST_F(SessionDevice, GivesNoForceBeforeItKnowsWhereTheToolIs) {
  move_to(0.002);
  ASSERT_TRUE(frames_until([&] { return bus_.counts == target_; }));
  ASSERT_TRUE(frames_until([&] { return session_->newest().device.zeroing == Zeroing::needed; }));
  EXPECT_FALSE(session_->device_words().empty());
  EXPECT_EQ(session_->newest().rendered_N, 0.0);
  EXPECT_EQ(bus_.motor_units(), 0.0);
  move_to(kRestPosition_m);
  ASSERT_TRUE(frames_until([&] { return bus_.counts == target_; }));
  session_->start_zeroing();
  ASSERT_TRUE(frames_until([&] { return zeroed(); }));
  EXPECT_TRUE(session_->device_words().empty()) << session_->device_words();
  move_to(0.002);
  EXPECT_TRUE(frames_until([&] {
    return std::abs(session_->newest().tick.position_m - 0.002) < 1e-4 && session_->newest().rendered_N > 0.05 &&
           bus_.motor_units() != 0.0;
  }));
}

TEST_F(SessionDevice, UnpluggingReleasesTheForceAndKeepsTheRecording) {
  session_->start_zeroing();
  ASSERT_TRUE(frames_until([&] { return zeroed(); }));
  session_->reset_figures();  // clears alarms due to a slow start
  const std::string path = folder_.file("live.csv");
  ASSERT_TRUE(frames_until([&] { return session_->has_reference(); }));
  ASSERT_TRUE(session_->start_recording(path).ok());
  move_to(0.002);
  ASSERT_TRUE(frames_until([&] { return session_->newest().rendered_N > 0.05 && session_->recording().rows > 200; }));

  bus_.plugged_in = false;
  ASSERT_TRUE(frames_until([&] { return (session_->newest().device.faults & device_fault::kUnplugged) != 0; }));
  ASSERT_TRUE(frames_until([&] { return session_->newest().rendered_N == 0.0; }));
  const std::string unplugged = device_fault_words(device_fault::kUnplugged).front();
  ASSERT_TRUE(frames_until([&] { return session_->device_words() == unplugged; })) << session_->device_words();
  const auto alarms = session_->alarms();
  EXPECT_NE(std::find(alarms.begin(), alarms.end(), unplugged), alarms.end());
  EXPECT_TRUE(std::any_of(session_->faults().events().begin(), session_->faults().events().end(),
                          [&](const FaultEvent& fault) { return fault.text == unplugged; }));

  // The second before the fault is saved, and a notice names the file.
  ASSERT_TRUE(frames_until([&] { return notice_with("the last second before the fault is in ") != nullptr; }));
  const Notice& notice = *notice_with("the last second before the fault is in ");
  EXPECT_FALSE(notice.problem);
  const std::string file = notice.text.substr(notice.text.find("fault-"));
  std::ifstream ticks(file);
  std::size_t lines = 0;
  for (std::string line; std::getline(ticks, line);) ++lines;
  EXPECT_GT(lines, 100u) << file;

  // Plugged in again: no force before it is zeroed, and the alarm stays until it is acknowledged.
  bus_.plugged_in = true;
  ASSERT_TRUE(frames_until([&] { return session_->newest().device.zeroing == Zeroing::needed; }));
  EXPECT_EQ(session_->newest().rendered_N, 0.0);
  move_to(kRestPosition_m);
  ASSERT_TRUE(frames_until([&] { return bus_.counts == target_; }));
  session_->start_zeroing();
  ASSERT_TRUE(frames_until([&] { return zeroed() && session_->newest().device.faults == 0; }))
      << session_->device_words();
  EXPECT_FALSE(session_->alarms().empty());
  EXPECT_TRUE(frames_until([&] {
    session_->reset_figures();  // repeated, because a slow machine may cause another alarm
    return session_->alarms().empty();
  }));

  const std::uint64_t rows = session_->recording().rows;
  ASSERT_TRUE(frames_until([&] { return session_->recording().rows > rows + 50; })) << "it goes on";
  session_->stop_recording();
  ASSERT_TRUE(frames_until([&] { return !session_->recording().active && !session_->recording().saving; }));
  EXPECT_GT(test::must(read_recording(path)).rows.size(), rows);
}

}  // namespace
}  // namespace palpate
