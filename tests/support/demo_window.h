// The real window on a virtual display, for tests of user input.
#pragma once

#include <epoxy/gl.h>
// Included after epoxy, which declares OpenGL's functions.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <string>

#include "models/model/file/model_io.h"
#include "rendering/app/demo_app.h"
#include "tests/support/example_model.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"

namespace palpate::test {

// A timeout for a heavily loaded machine.
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

  // Opens a scene without a virtual material, so that no fit runs during the test.
  void open(const std::string& device, bool exhibit = false) {
    DemoRequest request;
    request.session.scene = "skin";
    request.session.device = device;
    request.session.models = {folder_.file("soft.json"), folder_.file("firm.json")};
    request.session.realtime = false;  // tests do not need real-time priority
    request.exhibit = exhibit;
    auto app = DemoApp::create(request);
    ASSERT_TRUE(app.ok()) << app.error().message;
    app_ = std::move(*app);
    app_->view().settings.block_count = 1;
    ASSERT_TRUE(until([&] { return app_->session().models().all_settled(); }));
  }

  // Draws frames until `done`. False if that takes longer than kPatience_s.
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

  // Presses a key through the installed GLFW callbacks, as the operating system does.
  void press(int key, int modifiers = 0, bool held = false) {
    GLFWwindow* window = app_->window().handle();
    const GLFWkeyfun callback = glfwSetKeyCallback(window, nullptr);
    callback(window, key, 0, GLFW_PRESS, modifiers);
    if (held) app_->frame();
    callback(window, key, 0, GLFW_RELEASE, modifiers);
    glfwSetKeyCallback(window, callback);
    frames(2);
  }
  // Sends characters to the focused text field.
  void type(const std::string& text) {
    GLFWwindow* window = app_->window().handle();
    const GLFWcharfun callback = glfwSetCharCallback(window, nullptr);
    glfwSetCharCallback(window, callback);
    for (const char letter : text) callback(window, static_cast<unsigned char>(letter));
    frames(2);
  }
  // Holds the key down until `done`.
  template <typename Done>
  void hold(int key, Done done) {
    GLFWwindow* window = app_->window().handle();
    const GLFWkeyfun callback = glfwSetKeyCallback(window, nullptr);
    glfwSetKeyCallback(window, callback);
    callback(window, key, 0, GLFW_PRESS, 0);
    EXPECT_TRUE(until(done));
    callback(window, key, 0, GLFW_RELEASE, 0);
    frames(2);
  }
  // Clicks the left button at the mouse position.
  void click() {
    GLFWwindow* window = app_->window().handle();
    const GLFWmousebuttonfun callback = glfwSetMouseButtonCallback(window, nullptr);
    glfwSetMouseButtonCallback(window, callback);
    for (const int action : {GLFW_PRESS, GLFW_RELEASE}) {
      callback(window, GLFW_MOUSE_BUTTON_LEFT, action, 0);
      frames(2);
    }
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

}  // namespace palpate::test
