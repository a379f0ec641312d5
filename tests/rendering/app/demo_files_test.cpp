// Files that are opened while others are read, without a window.
#include "rendering/app/demo_files.h"

#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <thread>

#include "models/model/file/model_io.h"
#include "tests/support/example_model.h"
#include "tests/support/session_frames.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

// A long read must not block the window, because a blocked window releases the dead-man key.
TEST(DemoFiles, ASecondFileDoesNotWaitForTheFirstInTheWindow) {
  const test::TemporaryFolder folder;
  setenv("XDG_DATA_HOME", folder.path().c_str(), 1);
  const ModelData model = test::example_model("greedy", KernelKind::cubic, test::paper_features(), 1);
  ASSERT_TRUE(save_model(folder.file("m.json"), model, false).ok());
  auto session = LiveSession::open(test::session_request("skin", "hand", {folder.file("m.json")}));
  ASSERT_TRUE(session.ok()) << session.error().message;

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
  files.update(**session);
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(5));
  EXPECT_FALSE(view.dialogs.recording_roles.any());
  gate.set_value();
  for (int i = 0; i < 2000 && view.dialogs.recording_roles.recordings.size() < 2; ++i) {
    files.update(**session);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ASSERT_EQ(view.dialogs.recording_roles.recordings.size(), 2u) << "none is lost";
  EXPECT_EQ(view.dialogs.recording_roles.test(), "b.csv");
}

}  // namespace
}  // namespace palpate
