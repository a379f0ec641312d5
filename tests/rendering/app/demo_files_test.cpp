// The files of the window, without a window.
#include "rendering/app/demo_app.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <future>
#include <thread>

#include "engine/recording/recording.h"
#include "models/model/file/model_io.h"
#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"
#include "tests/support/session_frames.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

// A session of a model in `folder`, whose subfolder `data` receives the files of the user.
std::unique_ptr<LiveSession> session_in(const test::TemporaryFolder& folder, const std::string& data) {
  setenv("XDG_DATA_HOME", folder.file(data).c_str(), 1);
  const ModelData model = test::example_model("greedy", KernelKind::cubic, test::paper_features(), 1);
  EXPECT_TRUE(save_model(folder.file("m.json"), model, false).ok());
  return test::must(LiveSession::open(test::session_request("skin", "hand", {folder.file("m.json")})));
}

// A long read must not block the window, because a blocked window releases the dead-man key.
TEST(DemoFiles, ASecondFileDoesNotWaitForTheFirstInTheWindow) {
  const test::TemporaryFolder folder;
  const auto session = session_in(folder, "");

  std::promise<void> gate;
  const std::shared_future<void> opened = gate.get_future().share();
  ViewState view;
  DemoFiles files(
      view, [](const std::string&, bool) {},
      [opened](const std::string& path, const std::string&) -> Result<ConvertedRecording> {
        opened.wait();
        return ConvertedRecording{path, {}};
      });
  const auto began = std::chrono::steady_clock::now();
  files.open_recording("a.csv");
  files.open_recording("b.csv");
  files.update(*session);
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(5));
  EXPECT_FALSE(view.dialogs.recording_roles.any());
  gate.set_value();
  for (int i = 0; i < 2000 && view.dialogs.recording_roles.recordings.size() < 2; ++i) {
    files.update(*session);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ASSERT_EQ(view.dialogs.recording_roles.recordings.size(), 2u) << "none is lost";
  EXPECT_EQ(view.dialogs.recording_roles.tested, "b.csv");
}

// Two saves within a second, and a window that closes while another file is still being read.
TEST(DemoFiles, SavesThatWereRequestedAreCompletedWhenTheWindowCloses) {
  const test::TemporaryFolder folder;
  const auto session = session_in(folder, "");
  ASSERT_TRUE(test::frames_until(*session, [&] { return session->comparison().history().size() > 100; }));
  std::promise<void> gate;
  const std::shared_future<void> opened = gate.get_future().share();
  ViewState view;
  std::vector<std::string> problems;
  {
    DemoFiles files(
        view,
        [&](const std::string& text, bool problem) {
          if (problem) problems.push_back(text);
        },
        [opened](const std::string& path, const std::string&) -> Result<ConvertedRecording> {
          opened.wait();
          return ConvertedRecording{path, {}};
        });
    files.open_recording("a.csv");
    files.update(*session);
    for (int i = 0; i < 2; ++i) files.save_curves(*session, window_view(*session, view), CurveColumns());
    gate.set_value();
  }
  EXPECT_EQ(problems, std::vector<std::string>());
  std::size_t tables = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    if (entry.path().filename().string().rfind("curves-", 0) == 0 && entry.path().extension() == ".csv") ++tables;
  }
  EXPECT_EQ(tables, 2u);
}

TEST(DemoFiles, AnotherProgramsTableIsOfferedAsARecordingWithTheGuesses) {
  const test::TemporaryFolder folder;
  const auto session = session_in(folder, "data");
  const std::string foreign = folder.file("trial.txt");
  std::ofstream file(foreign);
  file << "Zeit [s];Weg [mm];Kraft [N]\n";
  for (int i = 0; i < 200; ++i) file << "0," << 1000 + i << ";1," << 100 + i << ";0," << 100 + i << "\n";
  file.close();

  ViewState view;
  std::vector<std::string> told;
  DemoFiles files(view, [&](const std::string& text, bool) { told.push_back(text); });
  files.open(foreign, *session);
  for (int i = 0; i < 2000 && !view.dialogs.recording_roles.any(); ++i) {
    files.update(*session);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(view.dialogs.recording_roles.problem, "");
  ASSERT_EQ(view.dialogs.recording_roles.recordings.size(), 1u);
  const ConvertedRecording& offered = view.dialogs.recording_roles.recordings[0];
  ASSERT_GE(offered.words.size(), 4u);
  EXPECT_EQ(offered.words[3].rfind("position: column 2 \"Weg [mm]\" ", 0), 0u) << offered.words[3];
  EXPECT_EQ(offered.path.rfind(folder.file("data/"), 0), 0u) << offered.path;
  const Result recording = test::must(read_recording(offered.path));
  EXPECT_EQ(recording->rows.size(), 200u);
  EXPECT_EQ(view.settings.recent, std::vector<std::string>{foreign});
  EXPECT_EQ(told.back(), "imported " + foreign + " as " + offered.path) << "no copy without a word";
}

TEST(Settings, ComeBackAsTheyWere) {
  const test::TemporaryFolder folder;
  Settings settings;
  settings.theme = Theme::dark;
  settings.text_size = 1.25F;
  settings.recent = {"b.csv", "a.json"};
  const std::string path = folder.file("window.json");
  ASSERT_TRUE(write_settings(path, settings).ok());
  ASSERT_TRUE(write_settings(path, settings).ok()) << "again";
  const Result back = test::must(read_settings(path));
  EXPECT_EQ(*back, settings);
  settings.blocks = 2;
  ASSERT_TRUE(write_settings(path, settings).ok());
  EXPECT_EQ(read_settings(path)->blocks, kAllBlocks) << "the next user starts with the comparison";
}

TEST(Settings, AreNoReasonNotToStart) {
  const test::TemporaryFolder folder;
  const Result missing = test::must(read_settings(folder.file("none.json")));
  EXPECT_EQ(*missing, Settings{});
  std::ofstream(folder.file("odd.json")) << R"({"blocks": 3, "theme": 7, "text_size": 99})";
  const Result odd = test::must(read_settings(folder.file("odd.json")));
  Settings expected;
  expected.text_size = kLargestText;
  EXPECT_EQ(*odd, expected);
  for (const char* broken : {"{", "[]", R"({"recent": {"distance": "far"}})"}) {
    std::ofstream(folder.file("broken.json")) << broken;
    EXPECT_FALSE(read_settings(folder.file("broken.json")).ok()) << broken;
  }
}

}  // namespace
}  // namespace palpate
