// The real window on a display in memory: what people do to it, and what it does.
#include "rendering/app/demo_app.h"
#include "rendering/panels/panel_views.h"

#include <epoxy/gl.h>
// After epoxy, which brings OpenGL's functions.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui_internal.h>
#include <png.h>

#include <algorithm>
#include <cstdlib>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "engine/recording/recording.h"
#include "models/model/file/model_io.h"
#include "tests/support/example_model.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"

namespace palpate {
namespace {

using test::TemporaryFolder;

// Enough for a loaded machine; nothing waits so long.
constexpr double kPatience_s = 60.0;

class DemoAppTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_FALSE(test::virtual_display().empty()) << "Xvfb does not start; apt-get install xvfb";
    save("soft.json", 1, 1.0);
    save("firm.json", 2, 1.6);
  }
  void TearDown() override { app_.reset(); }

  // A model of the four features; `firmness` scales what it answers.
  void save(const std::string& file, std::uint64_t seed, double firmness) {
    ModelData data = test::example_model("greedy", KernelKind::cubic, test::paper_features(), seed);
    data.name = file.substr(0, file.find('.'));
    for (double& value : data.trend.elastic_N) value *= firmness;
    ASSERT_TRUE(save_model(folder_.file(file), data, false).ok());
  }

  // A scene without a virtual material: no fit runs beside the test.
  void open(const std::string& device, bool kiosk = false) {
    DemoRequest request;
    request.session.scene = "skin";
    request.session.device = device;
    request.session.models = {folder_.file("soft.json"), folder_.file("firm.json")};
    request.session.realtime = false;  // a test does not outrank the machine it runs on
    request.kiosk = kiosk;
    auto app = DemoApp::create(request);
    ASSERT_TRUE(app.ok()) << app.error().message;
    app_ = std::move(*app);
    app_->view().block_count = 1;
    ASSERT_TRUE(until([&] { return app_->session().models().all_settled(); }));
  }

  // Frames until `done`; whether it came to that.
  template <typename Done>
  bool until(Done done) {
    const auto start = std::chrono::steady_clock::now();
    while (!done()) {
      if (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > kPatience_s)
        return false;
      app_->frame();
    }
    return true;
  }
  void frames(int count) {
    for (int i = 0; i < count; ++i) app_->frame();
  }

  // As the operating system would: through the callbacks that are installed.
  void press(int key, int modifiers = 0) {
    GLFWwindow* window = app_->window().handle();
    const GLFWkeyfun callback = glfwSetKeyCallback(window, nullptr);
    callback(window, key, 0, GLFW_PRESS, modifiers);
    callback(window, key, 0, GLFW_RELEASE, modifiers);
    glfwSetKeyCallback(window, callback);
    frames(2);
  }
  void drop(const std::string& path) {
    GLFWwindow* window = app_->window().handle();
    const GLFWdropfun callback = glfwSetDropCallback(window, nullptr);
    const char* paths[] = {path.c_str()};
    callback(window, 1, paths);
    glfwSetDropCallback(window, callback);
  }
  bool told(const std::string& words) const {
    const auto& toasts = app_->toasts();
    return std::any_of(toasts.begin(), toasts.end(),
                       [&](const Toast& toast) { return toast.text.find(words) != std::string::npos; });
  }

  TemporaryFolder folder_;
  std::unique_ptr<DemoApp> app_;
};

TEST_F(DemoAppTest, ShowsAPictureThatIsNotEmpty) {
  open("hand");
  frames(30);
  const std::string path = folder_.file("shot.png");
  ASSERT_TRUE(app_->screenshot(path, false).ok());
  EXPECT_FALSE(app_->screenshot(path, false).ok()) << "nothing is written over";
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0);
  EXPECT_EQ(image.width, 1280u);
  EXPECT_EQ(image.height, 720u);
  image.format = PNG_FORMAT_RGB;
  std::vector<unsigned char> pixels(PNG_IMAGE_SIZE(image));
  ASSERT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0);
  std::set<std::uint32_t> scene;
  std::set<std::uint32_t> panel;
  for (std::size_t i = 0; i < pixels.size(); i += 3) {
    const std::uint32_t colour =
        (std::uint32_t{pixels[i]} << 16) | (std::uint32_t{pixels[i + 1]} << 8) | pixels[i + 2];
    (i / 3 % image.width < 768 ? scene : panel).insert(colour);
  }
  EXPECT_GT(scene.size(), 2000u) << "shaded blocks";
  EXPECT_GT(panel.size(), 100u) << "text and curves";
}

TEST_F(DemoAppTest, ABadModelFileIsANoticeAndNotTheEnd) {
  open("hand");
  const std::string path = folder_.file("bad.json");
  std::ofstream(path) << "{\"format\": \"palpate-model\", \"version\": 1, \"name\": ";
  drop(path);
  ASSERT_TRUE(until([&] { return told("bad.json"); }));
  EXPECT_TRUE(app_->toasts().back().problem);
  EXPECT_EQ(app_->session().models().size(), 2u);
  drop(folder_.file("no such file.json"));
  ASSERT_TRUE(until([&] { return told("no such file.json"); }));
  EXPECT_FALSE(app_->closing());
}

TEST_F(DemoAppTest, ADroppedModelTakesPart) {
  open("hand");
  save("third.json", 3, 1.2);
  drop(folder_.file("third.json"));
  ASSERT_TRUE(until([&] { return app_->session().models().size() == 3 && app_->session().models().all_settled(); }));
  EXPECT_EQ(app_->session().models().view(2).name, "third");
  press(GLFW_KEY_3);
  EXPECT_EQ(app_->session().models().selected(), 2u);
}

// Never more than one JND in 10 ms, whatever the models differ by.
TEST_F(DemoAppTest, SwitchingWhilePressingFadesTheForce) {
  open("mouse");
  LiveSession& session = app_->session();
  session.mouse()->set_target(0.004, steady_now_s());
  ASSERT_TRUE(until([&] { return session.newest().tick.depth_m > 0.002; }));
  frames(60);  // at rest
  const double before_s = session.newest().loop_time_s;
  const double soft_N = session.models().view(0).force_N;
  const double firm_N = session.models().view(1).force_N;
  ASSERT_GT(firm_N, soft_N + session.jnd().at(soft_N)) << "a difference to fade over";
  press(GLFW_KEY_2);
  EXPECT_EQ(session.models().selected(), 1u);
  frames(40);
  press(GLFW_KEY_1);
  frames(40);
  const ForceHistory& history = session.comparison().history();
  const std::size_t first = history.first_at(before_s);
  double worst = 0.0;
  for (std::size_t i = first + 1; i < history.size(); ++i) {
    const double step_s = history[i].loop_time_s - history[i - 1].loop_time_s;
    const auto from_N = static_cast<double>(history[i - 1].rendered_N);
    const auto to_N = static_cast<double>(history[i].rendered_N);
    // A tick that comes late may go as far as the time that has passed, up to 10 ms.
    const double allowed_N =
        session.jnd().at(std::min(from_N, to_N)) * std::clamp(step_s, 0.001, 0.01) / 0.01;
    worst = std::max(worst, std::abs(to_N - from_N) / allowed_N);
  }
  // The tool gives way while the force changes, and the models' own forces with it:
  // a tenth more than the fade alone.
  EXPECT_LT(worst, 1.1);
}

TEST_F(DemoAppTest, ClosingWhileRecordingLeavesTheFileWhole) {
  setenv("XDG_DATA_HOME", folder_.path().c_str(), 1);
  const std::string replayed = folder_.file("strokes.csv");
  ASSERT_TRUE(write_recording(replayed, test::example_recording(2000, 1000.0), {}, false).ok());
  open("replay:" + replayed);
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

TEST_F(DemoAppTest, KeysDoWhatTheHelpSays) {
  open("hand");
  press(GLFW_KEY_T);
  EXPECT_EQ(app_->view().theme, Theme::dark);
  press(GLFW_KEY_B);
  EXPECT_EQ(app_->view().block_count, 2u);
  press(GLFW_KEY_SPACE);
  EXPECT_TRUE(app_->view().time.paused);
  press(GLFW_KEY_H);
  press(GLFW_KEY_L);
  press(GLFW_KEY_M);
  EXPECT_TRUE(app_->view().help && app_->view().details && app_->view().file_list);
  press(GLFW_KEY_ESCAPE);
  EXPECT_FALSE(app_->view().help || app_->view().details || app_->view().file_list);
  EXPECT_FALSE(app_->closing());
  press(GLFW_KEY_Q, GLFW_MOD_CONTROL);
  EXPECT_TRUE(app_->closing());
}

TEST_F(DemoAppTest, TheWheelMovesTheProbeAndWithCtrlTheCamera) {
  open("mouse");
  GLFWwindow* window = app_->window().handle();
  const auto scroll = [&](double steps) {
    const GLFWscrollfun callback = glfwSetScrollCallback(window, nullptr);
    glfwSetScrollCallback(window, callback);
    callback(window, 0.0, steps);
    app_->frame();
  };
  glfwFocusWindow(window);
  glfwSetCursorPos(window, 384.0, 380.0);
  frames(5);
  const double before_m = app_->session().newest().tick.position_m;
  for (int i = 0; i < 6; ++i) scroll(-1.0);
  EXPECT_TRUE(until([&] { return app_->session().newest().tick.position_m > before_m + 0.001; }));
}

TEST_F(DemoAppTest, TheKeysAreListedInsideTheSmallestWindow) {
  open("hand");
  app_->run(Command::help);
  app_->run(Command::file_list);
  for (const auto& [width, height] : {std::pair{900, 600}, std::pair{800, 480}, std::pair{800, 1050}}) {
    glfwSetWindowSize(app_->window().handle(), width, height);
    frames(8);
    for (const char* name : {"Keys", "Load a model", "buttons", "title"}) {
      const ImGuiWindow* window = ImGui::FindWindowByName(name);
      ASSERT_NE(window, nullptr) << name;
      EXPECT_GE(window->Pos.x, 0.0F) << name << " " << width;
      EXPECT_GE(window->Pos.y, 0.0F) << name << " " << width;
      EXPECT_LE(window->Pos.x + window->Size.x, static_cast<float>(width)) << name;
      EXPECT_LE(window->Pos.y + window->Size.y, static_cast<float>(height)) << name;
    }
  }
}

TEST_F(DemoAppTest, SavesWhatTheCurvesShow) {
  setenv("XDG_DATA_HOME", folder_.path().c_str(), 1);
  open("hand");
  frames(30);
  press(GLFW_KEY_S);
  ASSERT_TRUE(told("saved"));
  std::size_t figures = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.file("palpate")))
    figures += entry.path().extension() == ".svg" || entry.path().extension() == ".csv" ? 1 : 0;
  EXPECT_EQ(figures, 2u);
}

TEST_F(DemoAppTest, StandsStillAsAWholeAndSaysWhatItShows) {
  open("hand");
  frames(20);
  press(GLFW_KEY_SPACE);
  const CurveTime time = app_->view().time;
  frames(10);
  EXPECT_EQ(app_->view().time.end_s(1e9), time.end_s(0.0));
  press(GLFW_KEY_SPACE);
  EXPECT_FALSE(app_->view().time.paused);
}

TEST_F(DemoAppTest, SaysWhatThereIsNotForAKey) {
  open("hand");
  press(GLFW_KEY_D);
  EXPECT_EQ(app_->session().dead_man(), DeadMan::off);
  EXPECT_TRUE(told("no device that pushes"));
  press(GLFW_KEY_B);
  press(GLFW_KEY_B);
  EXPECT_EQ(app_->view().block_count, 4u);
  EXPECT_TRUE(told("2 of 4 blocks"));
}

TEST_F(DemoAppTest, ADroppedRecordingIsOfferedAndReplayed) {
  open("hand");
  const std::string strokes = folder_.file("strokes.csv");
  ASSERT_TRUE(write_recording(strokes, test::example_recording(2000, 1000.0), {}, false).ok());
  drop(strokes);
  EXPECT_EQ(app_->view().offered_recording, strokes);
  frames(3);
  press(GLFW_KEY_ESCAPE);
  EXPECT_EQ(app_->view().offered_recording, "");
}

TEST_F(DemoAppTest, ModelsAreRenamedAndTakenOut) {
  open("hand");
  LiveSession& session = app_->session();
  session.rename(1, "mine");
  EXPECT_EQ(session.models().view(1).name, "mine");
  session.rename(0, "mine");
  EXPECT_EQ(session.models().view(0).name, "mine-2") << "names stay distinct";
  session.remove(0);
  EXPECT_EQ(session.models().view(0).state, SlotState::hidden);
  EXPECT_EQ(session.models().selected(), 1u) << "the active model is one that is there";
  frames(10);
  press(GLFW_KEY_1);
  EXPECT_EQ(session.models().selected(), 1u) << "keys count what is listed";
}

TEST_F(DemoAppTest, AHardPressOfTheMouseEndsWhereTheDataEnd) {
  open("mouse");
  const double known_m = app_->session().models().trained_depth_m();
  ASSERT_LT(known_m, 0.1);
  GLFWwindow* window = app_->window().handle();
  glfwFocusWindow(window);
  glfwSetCursorPos(window, 384.0, 360.0);
  frames(5);
  glfwSetCursorPos(window, 384.0, 560.0);
  frames(60);
  EXPECT_LT(app_->session().newest().tick.position_m, 1.1 * known_m);
}

TEST_F(DemoAppTest, AKioskHasOneWayOut) {
  open("hand", true);
  EXPECT_EQ(app_->view().theme, Theme::dark);
  press(GLFW_KEY_ESCAPE);
  press(GLFW_KEY_Q, GLFW_MOD_CONTROL);
  glfwSetWindowShouldClose(app_->window().handle(), GLFW_TRUE);
  frames(2);
  EXPECT_FALSE(app_->closing());
  press(GLFW_KEY_T);
  EXPECT_EQ(app_->view().theme, Theme::dark) << "a visitor changes nothing";
  press(GLFW_KEY_Q, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT);
  EXPECT_TRUE(app_->closing());
}

TEST_F(DemoAppTest, AVisitorsChoiceStaysASecretUntilTheAnswer) {
  open("hand", true);
  press(GLFW_KEY_1);
  EXPECT_EQ(app_->view().hidden_choice, 1);
  EXPECT_TRUE(app_->view().revealed.empty()) << "no curve gives it away";
  press(GLFW_KEY_D);
  EXPECT_EQ(app_->view().hidden_choice, 1) << "both have to be tried";
  press(GLFW_KEY_2);
  EXPECT_EQ(app_->view().hidden_choice, 2);
  press(GLFW_KEY_D);
  EXPECT_EQ(app_->view().hidden_choice, 0);
  EXPECT_EQ(app_->view().revealed.size(), 2u);
}

TEST_F(DemoAppTest, SaysWhenTheProbeIsAwayFromTheData) {
  open("mouse");
  EXPECT_FALSE(models_view(app_->session()).out_of_domain());
  app_->session().mouse()->set_target(0.03, steady_now_s());  // example models know 6 mm
  EXPECT_TRUE(until([&] { return models_view(app_->session()).out_of_domain(); }));
}

TEST_F(DemoAppTest, MovingTheMouseOverTheBlockTakesOverFromTheHand) {
  open("auto");
  GLFWwindow* window = app_->window().handle();
  glfwFocusWindow(window);
  frames(3);
  EXPECT_TRUE(app_->session().mouse()->hand_is_exploring());
  // Beside the block nothing happens; over it, lower is deeper.
  glfwSetCursorPos(window, 20.0, 300.0);
  frames(5);
  EXPECT_TRUE(app_->session().mouse()->hand_is_exploring());
  glfwSetCursorPos(window, 384.0, 380.0);
  ASSERT_TRUE(until([&] { return !app_->session().mouse()->hand_is_exploring(); }));
  frames(30);
  const double high_m = app_->session().newest().tick.position_m;
  glfwSetCursorPos(window, 384.0, 430.0);
  ASSERT_TRUE(until([&] { return app_->session().newest().tick.position_m > high_m + 0.001; }));
}

TEST_F(DemoAppTest, FollowsTheSizeOfItsWindow) {
  open("hand");
  glfwSetWindowSize(app_->window().handle(), 1920, 1080);
  frames(5);
  const std::string path = folder_.file("large.png");
  ASSERT_TRUE(app_->screenshot(path, false).ok());
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0);
  EXPECT_EQ(image.width, 1920u);
  EXPECT_EQ(image.height, 1080u);
  png_image_free(&image);
}

}  // namespace
}  // namespace palpate
