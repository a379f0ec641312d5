// Keys, buttons and the list of keys.
#include <imgui_internal.h>

#include <filesystem>
#include <set>

#include "engine/live/pacer.h"
#include "rendering/panels/panel.h"
#include "tests/support/demo_window.h"

namespace palpate {
namespace {

class DemoCommandsTest : public test::DemoWindowTest {
 protected:
  // Opens a list. It gets the focus a few frames after its key.
  void open_list(int key) {
    press(key);
    frames(4);
  }
  void export_item(int what) {
    open_list(GLFW_KEY_E);
    for (int i = 0; i < what; ++i) press(GLFW_KEY_DOWN);
    press(GLFW_KEY_ENTER);
  }
  std::size_t exported(const std::string& start, const char* extension) const {
    std::size_t files = 0;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.file("palpate"), none))
      files += entry.path().filename().string().rfind(start, 0) == 0 && entry.path().extension() == extension ? 1 : 0;
    return files;
  }
};

TEST_F(DemoCommandsTest, EveryRowIsReachedByItsKeysAndListedInTheHelp) {
  open("replay:" + save_strokes("strokes.csv"));
  std::set<std::pair<int, bool>> keys;
  for (WindowCommand& command : app_->commands()) {
    EXPECT_FALSE(shown_keys(command).empty()) << command.help;
    EXPECT_FALSE(command.help.empty()) << shown_keys(command);
    EXPECT_TRUE(command.label.empty() || !command.keys.empty()) << command.label << " is a button without a key";
    std::vector<std::size_t> ran;
    command.run = [&](std::size_t key) { ran.push_back(key); };
    for (std::size_t i = 0; i < command.keys.size(); ++i) {
      EXPECT_TRUE(keys.insert({command.keys[i], command.control}).second) << shown_keys(command) << " does two things";
      ran.clear();
      press(command.keys[i], command.control ? GLFW_MOD_CONTROL : 0, command.when == WindowCommand::When::held);
      EXPECT_EQ(ran, std::vector<std::size_t>{i}) << shown_keys(command) << ": " << command.help;
    }
  }
}

TEST_F(DemoCommandsTest, AButtonDoesWhatItsKeyDoes) {
  open("hand");
  frames(3);
  ImGuiWindow* buttons = ImGui::FindWindowByName("over buttons");
  ASSERT_NE(buttons, nullptr);
  glfwFocusWindow(app_->window().handle());
  // Moves the mouse to the first button, Open.
  const ImVec2 padding = ImGui::GetStyle().WindowPadding;
  move_mouse(static_cast<double>(buttons->Pos.x + padding.x + 8.0F),
             static_cast<double>(buttons->Pos.y + padding.y + 6.0F), 3);
  click();
  EXPECT_EQ(app_->view().dialogs.open, Dialog::files);
}

TEST_F(DemoCommandsTest, ARecordingGoesOnByOneSample) {
  open("replay:" + save_strokes("strokes.csv"));
  ReplayControl& replay = *app_->session().replay();
  press(GLFW_KEY_PERIOD);
  EXPECT_TRUE(replay.paused());
  frames(3);
  const double before_s = replay.playhead_s();
  press(GLFW_KEY_PERIOD);
  ASSERT_TRUE(until([&] { return replay.playhead_s() > before_s; }));
  EXPECT_NEAR(replay.playhead_s() - before_s, 1e-3, 1e-9);
  press(GLFW_KEY_COMMA);
  ASSERT_TRUE(until([&] { return replay.playhead_s() < before_s + 0.5e-3; }));
  EXPECT_NEAR(replay.playhead_s(), before_s, 1e-9);
}

TEST_F(DemoCommandsTest, ClosingWhileRecordingLeavesTheFileWhole) {
  open("replay:" + save_strokes("strokes.csv"));
  press(GLFW_KEY_R);
  const std::string path = app_->session().recording().path;
  EXPECT_TRUE(app_->session().recording().active);
  ASSERT_TRUE(until([&] { return app_->session().recording().rows > 300; }));
  EXPECT_FALSE(std::filesystem::exists(path)) << "not before it is whole";
  app_.reset();
  EXPECT_EQ(path.rfind(folder_.file("palpate/session-"), 0), 0u) << path;
  const auto recording = read_recording(path);
  ASSERT_TRUE(recording.ok()) << recording.error().message;
  EXPECT_GT(recording->rows.size(), 300u);
}

TEST_F(DemoCommandsTest, TheFilePickerListsFoldersAndWhatCanBeOpened) {
  std::filesystem::create_directory(folder_.file("lab"));
  for (const char* name : {"b.csv", "a.json", ".hidden.csv", "picture.png"}) folder_.with_file(name, "x");
  EXPECT_EQ(pickable_files(folder_.path()),
            (std::vector<std::string>{"lab/", "a.json", "b.csv", "firm.json", "soft.json"}));
  EXPECT_TRUE(pickable_files(folder_.file("nowhere")).empty());
}

TEST_F(DemoCommandsTest, OpenTakesTheFocusAndATypedPathReplacesTheOldOne) {
  open("hand");
  save("third.json", 3, 1.2);
  open_list(GLFW_KEY_O);
  ASSERT_TRUE(ImGui::GetIO().WantTextInput) << "the path can be typed at once";
  type(folder_.file("nowhere.json"));
  press(GLFW_KEY_ENTER);
  EXPECT_TRUE(told("there is no file " + folder_.file("nowhere.json")));
  EXPECT_TRUE(app_->view().settings.recent.empty());
  EXPECT_EQ(app_->view().dialogs.open, Dialog::none);
  open_list(GLFW_KEY_O);
  type(folder_.file("third.json"));
  EXPECT_EQ(app_->view().dialogs.picker.path.data(), folder_.file("third.json"));
  press(GLFW_KEY_ENTER);
  EXPECT_EQ(app_->session().models().size(), 3u);
  EXPECT_EQ(app_->view().settings.recent, std::vector<std::string>{folder_.file("third.json")});
}

TEST_F(DemoCommandsTest, AFileIsChosenWithKeysAlone) {
  open("hand");
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::create_directory(folder_.file("lab"));
  save("lab/third.json", 3, 1.2);
  std::filesystem::current_path(folder_.path());
  open_list(GLFW_KEY_O);
  press(GLFW_KEY_DOWN);  // ../
  press(GLFW_KEY_DOWN);  // lab/
  press(GLFW_KEY_ENTER);
  std::filesystem::current_path(before);
  ASSERT_EQ(app_->view().dialogs.open, Dialog::files);
  EXPECT_EQ(app_->view().dialogs.picker.files, std::vector<std::string>{"third.json"});
  frames(4);
  press(GLFW_KEY_DOWN);
  press(GLFW_KEY_DOWN);  // third.json
  press(GLFW_KEY_ENTER);
  EXPECT_EQ(app_->session().models().size(), 3u);
  EXPECT_EQ(app_->view().dialogs.open, Dialog::none);
}

TEST_F(DemoCommandsTest, EveryButtonHasItsFirstLetterAsKey) {
  open("hand");
  for (const WindowCommand& command : app_->commands())
    EXPECT_TRUE(!command.bar || key_name(command.keys[0]) == command.label.substr(0, 1)) << command.label;
}

TEST_F(DemoCommandsTest, TabReachesEveryButton) {
  open("hand");
  press(GLFW_KEY_TAB);
  press(GLFW_KEY_TAB);
  press(GLFW_KEY_ENTER);
  EXPECT_EQ(app_->view().dialogs.open, Dialog::scenes) << "the second button";
  press(GLFW_KEY_ESCAPE);
  EXPECT_EQ(app_->view().focus, -1);
  press(GLFW_KEY_SPACE);
  EXPECT_TRUE(app_->view().time.paused) << "without a focus, Space stops";
}

// Space stops blocks, curves, numbers and the replay, or none of them.
TEST_F(DemoCommandsTest, SpaceStopsEverything) {
  open("replay:" + save_strokes("strokes.csv"));
  frames(30);
  press(GLFW_KEY_SPACE);
  EXPECT_TRUE(app_->session().replay()->paused() && app_->shown().models.stands);
  const double at_s = app_->shown().models.now.loop_time_s;
  frames(10);
  EXPECT_EQ(app_->shown().models.now.loop_time_s, at_s);
  press(GLFW_KEY_SPACE);
  EXPECT_FALSE(app_->session().replay()->paused() || app_->view().time.paused);
}

TEST_F(DemoCommandsTest, ListsAreUsedWithKeysAlone) {
  open("mouse");
  open_list(GLFW_KEY_V);
  press(GLFW_KEY_RIGHT);
  press(GLFW_KEY_SPACE);
  EXPECT_EQ(app_->view().settings.blocks, 2u);
  EXPECT_FALSE(app_->view().time.paused) << "the space bar belongs to the list";
  const double before_m = app_->session().newest().tick.position_m;
  press(GLFW_KEY_DOWN);
  frames(20);
  EXPECT_NEAR(app_->session().newest().tick.position_m, before_m, 1e-6) << "so do the arrows";
  press(GLFW_KEY_ESCAPE);
  EXPECT_FALSE(app_->view().dialogs.any());

  // The current scene has the focus at first.
  open_list(GLFW_KEY_S);
  const ImGuiID own = ImGui::GetFocusID();
  press(GLFW_KEY_DOWN);
  EXPECT_NE(ImGui::GetFocusID(), own);
  press(GLFW_KEY_UP);
  EXPECT_EQ(ImGui::GetFocusID(), own);
  press(GLFW_KEY_ENTER);
  EXPECT_EQ(app_->view().dialogs.open, Dialog::none);
  EXPECT_TRUE(app_->session().scene().has_material());

  open_list(GLFW_KEY_D);
  ASSERT_TRUE(until([&] { return !app_->view().devices.empty(); }));
  frames(4);
  for (int i = 0; i < 9; ++i) press(GLFW_KEY_UP);
  for (int i = 0; i < 9 && app_->view().dialogs.any(); ++i) {
    if (ImGui::FindWindowByName("Device")->GetID("hand") == ImGui::GetFocusID()) {
      press(GLFW_KEY_ENTER);
    } else {
      press(GLFW_KEY_DOWN);
    }
  }
  EXPECT_EQ(app_->session().device_name(), "hand");
}

TEST_F(DemoCommandsTest, KeysDoWhatTheHelpSays) {
  open("hand");
  press(GLFW_KEY_T);
  EXPECT_EQ(app_->view().settings.theme, Theme::dark);
  press(GLFW_KEY_B);
  EXPECT_EQ(app_->view().settings.blocks, 2u);
  press(GLFW_KEY_SPACE);
  EXPECT_TRUE(app_->view().time.paused);
  press(GLFW_KEY_SPACE);
  EXPECT_FALSE(app_->view().time.paused);
  press(GLFW_KEY_H);
  press(GLFW_KEY_L);
  EXPECT_TRUE(app_->view().dialogs.open == Dialog::help && app_->view().details);
  press(GLFW_KEY_V);
  EXPECT_EQ(app_->view().dialogs.open, Dialog::view) << "one at a time";
  press(GLFW_KEY_ESCAPE);
  EXPECT_FALSE(app_->view().dialogs.any() || app_->view().details);
  EXPECT_FALSE(app_->closing());
  press(GLFW_KEY_Q, GLFW_MOD_CONTROL);
  EXPECT_TRUE(app_->closing());
}

TEST_F(DemoCommandsTest, TheKeysAreListedInsideTheSmallestWindow) {
  open("hand");
  for (const auto& [key, dialog] : {std::pair{GLFW_KEY_H, "Help"}, {GLFW_KEY_O, "Open a file"}}) {
    press(key);
    for (const auto& [width, height] : {std::pair{900, 600}, std::pair{800, 480}, std::pair{800, 1050}}) {
      glfwSetWindowSize(app_->window().handle(), width, height);
      frames(8);
      for (const char* name : {dialog, "over buttons", "over title"}) {
        const ImGuiWindow* window = ImGui::FindWindowByName(name);
        ASSERT_NE(window, nullptr) << name;
        EXPECT_GE(window->Pos.x, 0.0F) << name << " " << width;
        EXPECT_GE(window->Pos.y, 0.0F) << name << " " << width;
        EXPECT_LE(window->Pos.x + window->Size.x, static_cast<float>(width)) << name;
        EXPECT_LE(window->Pos.y + window->Size.y, static_cast<float>(height)) << name;
      }
    }
  }
}

TEST_F(DemoCommandsTest, TheForceInTheHandIsScaledUntilItIsSwitchedOff) {
  open("hand");
  EXPECT_EQ(app_->session().controls().scale, ForceScale{});
  press(GLFW_KEY_F);
  EXPECT_TRUE(app_->view().scales_force);
  EXPECT_NE(ImGui::FindWindowByName("over feel"), nullptr);
  app_->session().controls().scale = {2.0, 5.0};
  frames(2);
  press(GLFW_KEY_F);
  EXPECT_EQ(app_->session().controls().scale, ForceScale{});
}

TEST_F(DemoCommandsTest, SavesWhatTheCurvesShow) {
  open("hand");
  frames(30);
  for (int what = 0; what < 4; ++what) export_item(what);
  ASSERT_TRUE(until([&] { return told(".svg and .csv") || exported("curves-", ".svg") > 0; }));
  ASSERT_TRUE(until([&] { return exported("picture-", ".png") == 1 && exported("table-", ".csv") == 1; }));
  EXPECT_EQ(exported("curves-", ".svg") + exported("curves-", ".csv"), 2u);
}

TEST_F(DemoCommandsTest, WithoutGnuplotTheCurvesAreSavedAsData) {
  open("hand");
  frames(30);
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder_.path().c_str(), 1);
  export_item(1);
  EXPECT_TRUE(until([&] { return told(".csv without a figure: found no gnuplot in PATH, which draws the figures"); }));
  setenv("PATH", path.c_str(), 1);
}

TEST_F(DemoCommandsTest, SavesTheModelInTheHand) {
  open("hand");
  export_item(4);
  ASSERT_TRUE(told("saved soft to "));
  std::size_t models = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.file("palpate")))
    models += load_model(entry.path().string()).ok() ? 1 : 0;
  EXPECT_EQ(models, 1u);
}

TEST_F(DemoCommandsTest, APressIsExplainedUntilItWasDone) {
  open("mouse");
  frames(5);
  EXPECT_FALSE(app_->view().has_pressed);
  app_->session().tool_input()->set_target(-0.004, steady_now_s());
  frames(20);
  EXPECT_FALSE(app_->view().has_pressed) << "above the block there is nothing to feel";
  app_->session().tool_input()->set_target(0.005, steady_now_s());
  EXPECT_TRUE(until([&] { return app_->view().has_pressed; }));
}

TEST_F(DemoCommandsTest, SaysWhatThereIsNotForAKey) {
  open("hand");
  for (int i = 0; i < 3; ++i) press(GLFW_KEY_A);
  EXPECT_EQ(app_->session().controls().dead_man, DeadMan::off);
  EXPECT_TRUE(told("no device that pushes"));
  EXPECT_EQ(app_->view().toasts.size(), 1u) << "the same notice is there once";
  press(GLFW_KEY_B);
  press(GLFW_KEY_B);
  EXPECT_EQ(app_->view().settings.blocks, kAllBlocks);
}

}  // namespace
}  // namespace palpate
