// The exhibit as visitors use it: with a mouse, with keys, by touch.
#include "rendering/panels/open_day.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "tests/support/demo_window.h"

namespace palpate {
namespace {

// Of this process in memory, MB.
double resident_MB() {
  std::ifstream file("/proc/self/statm");
  double total = 0.0, resident = 0.0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

class OpenDayTest : public test::DemoWindowTest {
 protected:
  using State = AbTrial::State;
  State state() const { return app_->exhibit().trial().state(); }
  bool shows(const std::string& button) const { return app_->exhibit().buttons().count(button) != 0; }

  // So far under the middle of the block's top, in pixels.
  ImVec2 block(float below_px) const {
    const glm::vec2 size(768.0F, 720.0F);
    const glm::vec2 top = app_->blocks().on_screen(0, 1, {0.0F, 0.0F, 0.0F}, size);
    return {top.x, top.y + below_px};
  }
  void move(const ImVec2& to) {
    glfwSetCursorPos(app_->window().handle(), static_cast<double>(to.x), static_cast<double>(to.y));
    frames(3);
  }
  // A hand on a mouse goes there and clicks.
  void click_on(const std::string& button) {
    ASSERT_TRUE(until([&] { return shows(button); })) << button;
    move(app_->exhibit().buttons().at(button));
    click();
  }
  // A finger: the pointer is there and pressed in the same moment, and nowhere before.
  void touch(const ImVec2& at) {
    GLFWwindow* window = app_->window().handle();
    const GLFWmousebuttonfun callback = glfwSetMouseButtonCallback(window, nullptr);
    glfwSetMouseButtonCallback(window, callback);
    glfwSetCursorPos(window, static_cast<double>(at.x), static_cast<double>(at.y));
    callback(window, GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, 0);
    frames(3);
    callback(window, GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, 0);
    frames(3);
  }
  void touch_on(const std::string& button) {
    ASSERT_TRUE(until([&] { return shows(button); })) << button;
    touch(app_->exhibit().buttons().at(button));
  }
  void press_block_with_mouse() {
    for (const float below_px : {0.0F, 12.0F, 24.0F, 12.0F, -12.0F}) move(block(below_px));
  }
  void press_block_with_keys() {
    hold(GLFW_KEY_DOWN, [&] { return app_->session().newest().tick.depth_m > 0.002; });
    hold(GLFW_KEY_UP, [&] { return !app_->session().newest().tick.in_contact; });
  }

  void visit_with_mouse() {
    move(block(0.0F));
    ASSERT_TRUE(until([&] { return state() == State::exploring; }));
    press_block_with_mouse();
    click_on("2");
    press_block_with_mouse();
    click_on("D");
  }
  void visit_with_keys() {
    press(GLFW_KEY_1);
    ASSERT_EQ(state(), State::exploring);
    press_block_with_keys();
    press(GLFW_KEY_2);
    press_block_with_keys();
    press(GLFW_KEY_S);
  }
  void visit_by_touch() {
    touch_on("1");
    ASSERT_EQ(state(), State::exploring);
    for (const float below_px : {6.0F, 24.0F}) touch(block(below_px));
    touch_on("2");
    for (const float below_px : {6.0F, 24.0F}) touch(block(below_px));
    touch_on("S");
  }
  void expect_answered(std::uint64_t answers) {
    EXPECT_EQ(state(), State::answered);
    EXPECT_TRUE(app_->exhibit().trial().touched());
    EXPECT_EQ(app_->exhibit().tally().answers, answers);
    EXPECT_EQ(app_->view().revealed.size(), 2u);
    EXPECT_TRUE(app_->view().time.paused) << "what was pressed stays to be looked at";
  }
};

TEST_F(OpenDayTest, IsVisitedWithAMouseAlone) {
  open("auto", true);
  visit_with_mouse();
  expect_answered(1);
  click_on("N");
  EXPECT_EQ(state(), State::exploring);
  EXPECT_FALSE(app_->view().time.paused);
}

TEST_F(OpenDayTest, IsVisitedWithKeysAlone) {
  open("auto", true);
  visit_with_keys();
  expect_answered(1);
  press(GLFW_KEY_N);
  EXPECT_EQ(state(), State::exploring);
}

TEST_F(OpenDayTest, IsVisitedByTouchAlone) {
  open("auto", true);
  visit_by_touch();
  expect_answered(1);
  touch_on("N");
  EXPECT_EQ(state(), State::exploring);
}

// As many as PALPATE_VISITORS says (30 take some ten minutes), else two: with a mouse, with
// keys, by touch, in turns; after every third one nobody comes until the exhibit forgets.
TEST_F(OpenDayTest, IsAsNewAfterManyVisitors) {
  const char* asked = std::getenv("PALPATE_VISITORS");
  const int visitors = asked != nullptr ? std::atoi(asked) : 2;
  open("auto", true);
  frames(5);
  const ImVec2 home = block(0.0F);
  double first_MB = 0.0;
  for (int i = 0; i < visitors; ++i) {
    switch (i % 3) {
      case 0: visit_with_mouse(); break;
      case 1: visit_with_keys(); break;
      default: visit_by_touch(); break;
    }
    expect_answered(static_cast<std::uint64_t>(i) + 1);
    if (i % 3 != 2) {
      press(GLFW_KEY_N);  // the next one is there already
      continue;
    }
    ASSERT_TRUE(until([&] { return state() == State::idle; })) << "forgotten after 20 s";
    EXPECT_TRUE(app_->view().revealed.empty());
    EXPECT_FALSE(app_->view().time.paused);
    EXPECT_EQ(app_->session().models().selected(), 0u);
    EXPECT_NEAR(block(0.0F).x, home.x, 0.5F);
    EXPECT_NEAR(block(0.0F).y, home.y, 0.5F);
    if (first_MB == 0.0) first_MB = resident_MB();
    const TimePercentiles late = app_->session().loop().statistics().lateness;
    std::printf("visitor %d: %.1f MB, %llu frames, %llu ticks, late p50 %.0f us\n", i + 1, resident_MB(),
                static_cast<unsigned long long>(app_->frames().frames),
                static_cast<unsigned long long>(app_->session().loop().statistics().ticks), late.p50_us);
  }
  if (first_MB > 0.0) {
    EXPECT_LT(resident_MB(), first_MB + 8.0) << "memory grows with every visitor";
  }
}

TEST_F(OpenDayTest, AKioskHasOneWayOut) {
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

TEST_F(OpenDayTest, AVisitorsChoiceStaysASecretUntilTheAnswer) {
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
}  // namespace
}  // namespace palpate
