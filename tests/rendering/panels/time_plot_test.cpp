// The effect of the mouse on the curves of the window.
#include "rendering/panels/time_plot.h"

#include <imgui.h>

#include <cmath>

#include "tests/support/demo_window.h"

namespace palpate {
namespace {

class TimePlotTest : public test::DemoWindowTest {
 protected:
  // Moves the mouse over the force plot of a window of 1280 x 720.
  void move(double x) { move_mouse(x, 100.0, 3); }
  void button(int action) { left_button(action, 1); }
};

TEST_F(TimePlotTest, ReadsZoomsAndRunsAgain) {
  open("hand");
  frames(10);
  CurveTime& time = app_->view().time;
  move(900.0);
  EXPECT_FALSE(std::isnan(time.hover_s)) << "a crosshair";
  const double first_s = time.hover_s;
  send(glfwSetKeyCallback, GLFW_KEY_LEFT_SHIFT, 0, GLFW_PRESS, GLFW_MOD_SHIFT);
  button(GLFW_PRESS);
  move(1000.0);
  button(GLFW_RELEASE);
  send(glfwSetKeyCallback, GLFW_KEY_LEFT_SHIFT, 0, GLFW_RELEASE, 0);
  ASSERT_TRUE(time.paused);
  EXPECT_LT(time.shown_s, 0.6 * kShown_s);
  EXPECT_NEAR(time.end_s(0.0) - time.shown_s, first_s, 1.0) << "from where the drag began; the curves ran on meanwhile";
  ImGui::GetIO().MouseDoubleClickTime = 5.0F;  // frames may be slow on a loaded machine
  for (const int action : {GLFW_PRESS, GLFW_RELEASE, GLFW_PRESS, GLFW_RELEASE}) button(action);
  EXPECT_FALSE(time.paused);
  EXPECT_EQ(time.shown_s, kShown_s);
  move(300.0);
  EXPECT_TRUE(std::isnan(time.hover_s));
}

}  // namespace
}  // namespace palpate
