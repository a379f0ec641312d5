// The real window on a virtual display, for tests of user input.
#pragma once

#include <epoxy/gl.h>
// Included after epoxy, which declares OpenGL's functions.
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <string>

#include "engine/recording/recording.h"
#include "models/model/file/model_io.h"
#include "rendering/app/demo_app.h"
#include "tests/support/example_model.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"

namespace palpate::test {

// A timeout that suits a heavily loaded machine.
inline constexpr double kPatience_s = 60.0;

class DemoWindowTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_FALSE(virtual_display().empty()) << "Xvfb does not start; apt-get install xvfb";
    setenv("XDG_DATA_HOME", folder_.path().c_str(), 1);  // keeps test files out of the user's folders
    save("soft.json", 1, 1.0);
    save("firm.json", 2, 1.6);
  }
  void TearDown() override { app_.reset(); }

  // Saves a model of the paper's four features. `firmness` scales its force.
  void save(const std::string& file, std::uint64_t seed, double firmness) {
    ModelData data = example_model("greedy", KernelKind::cubic, paper_features(), seed);
    data.name = file.substr(0, file.find('.'));
    for (double& value : data.trend.elastic.pieces_N) value *= firmness;
    ASSERT_TRUE(save_model(folder_.file(file), data, false).ok());
  }

  DemoRequest request(const std::string& scene, const std::string& device) {
    DemoRequest request;
    request.session.scene = scene;
    request.session.device = device;
    request.session.models = {folder_.file("soft.json"), folder_.file("firm.json")};
    request.session.realtime = false;  // tests do not need real-time priority
    return request;
  }
  void start(const DemoRequest& request) {
    auto app = DemoApp::create(request);
    ASSERT_TRUE(app.ok()) << app.error().message;
    app_ = std::move(*app);
  }
  // Saves strokes as a recording. Returns its path.
  std::string save_strokes(const std::string& file, std::size_t rows = 2000, double rate_Hz = 1000.0) {
    EXPECT_TRUE(write_recording(folder_.file(file), example_recording(rows, rate_Hz), {}, false).ok());
    return folder_.file(file);
  }

  // Opens a scene without a virtual material, so that no fit runs during the test.
  void open(const std::string& device) {
    start(request("skin", device));
    app_->view().settings.blocks = 1;
    ASSERT_TRUE(until([&] { return app_->session().models().all_settled(); }));
  }

  // Draws frames until `done` returns true. Returns false after kPatience_s.
  template <typename Done>
  bool until(Done done) {
    const auto start = std::chrono::steady_clock::now();
    while (!done()) {
      if (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > kPatience_s) return false;
      app_->frame();
    }
    return true;
  }
  void frames(int count) {
    for (int i = 0; i < count; ++i) app_->frame();
  }

  // Calls the callback that is installed by `set`, a function of GLFW, as the operating system does.
  template <typename Callback, typename... Arguments>
  void send(Callback (*set)(GLFWwindow*, Callback), Arguments... arguments) {
    GLFWwindow* window = app_->window().handle();
    const Callback callback = set(window, nullptr);
    set(window, callback);
    callback(window, arguments...);
  }
  void press(int key, int modifiers = 0, bool held = false) {
    send(glfwSetKeyCallback, key, 0, GLFW_PRESS, modifiers);
    if (held) app_->frame();
    send(glfwSetKeyCallback, key, 0, GLFW_RELEASE, modifiers);
    frames(2);
  }
  // Sends characters to the focused text field.
  void type(const std::string& text) {
    for (const char letter : text) send(glfwSetCharCallback, static_cast<unsigned char>(letter));
    frames(2);
  }
  // Holds the key down until `done`.
  template <typename Done>
  void hold(int key, Done done) {
    send(glfwSetKeyCallback, key, 0, GLFW_PRESS, 0);
    EXPECT_TRUE(until(done));
    send(glfwSetKeyCallback, key, 0, GLFW_RELEASE, 0);
    frames(2);
  }
  // Moves the mouse, and presses or releases its left button, in the window's units.
  void move_mouse(double x, double y, int then = 0) {
    glfwSetCursorPos(app_->window().handle(), x, y);
    frames(then);
  }
  void left_button(int action, int then = 2) {
    send_left_button(app_->window().handle(), action == GLFW_PRESS);
    frames(then);
  }
  void click() {
    for (const int action : {GLFW_PRESS, GLFW_RELEASE}) left_button(action);
  }
  void drop(const std::string& path) {
    const char* paths[] = {path.c_str()};
    send(glfwSetDropCallback, 1, static_cast<const char**>(paths));
  }
  bool told(const std::string& words) const {
    const auto& toasts = app_->view().toasts;
    return std::any_of(toasts.begin(), toasts.end(),
                       [&](const Toast& toast) { return toast.text.find(words) != std::string::npos; });
  }

  TemporaryFolder folder_;
  std::unique_ptr<DemoApp> app_;
};

}  // namespace palpate::test
