// Mouse, wheel and keys in the window.
#include <chrono>
#include <cmath>
#include <thread>

#include "tests/support/demo_window.h"

namespace palpate {
namespace {

class DemoInputTest : public test::DemoWindowTest {
 protected:
  void point_at(double x, double y) {
    glfwFocusWindow(app_->window().handle());
    move_mouse(x, y, 5);
  }
};

// The force changes by at most one JND in 10 ms, for any difference between the models.
TEST_F(DemoInputTest, SwitchingWhilePressingFadesTheForce) {
  open("mouse");
  LiveSession& session = app_->session();
  session.tool_input()->set_target(0.004, steady_now_s());
  ASSERT_TRUE(until([&] { return session.newest().tick.depth_m > 0.002; }));
  frames(60);  // at rest
  const double before_s = session.newest().loop_time_s;
  const double soft_N = session.figures(0).force_N;
  const double firm_N = session.figures(1).force_N;
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
    // After a late tick the change may be that of the elapsed time, up to 10 ms.
    const double allowed_N = session.jnd().at(std::min(from_N, to_N)) * std::clamp(step_s, 0.001, 0.01) / 0.01;
    worst = std::max(worst, std::abs(to_N - from_N) / allowed_N);
  }
  // The tool moves while the force changes, so that the forces of the models change too.
  // The tolerance for that is a tenth of the fade.
  EXPECT_LT(worst, 1.1);
}

TEST_F(DemoInputTest, TheWheelMovesTheProbeAndWithCtrlTheCamera) {
  open("mouse");
  point_at(384.0, 380.0);
  const double before_m = app_->session().newest().tick.position_m;
  for (int i = 0; i < 6; ++i) {
    send(glfwSetScrollCallback, 0.0, -1.0);
    app_->frame();
  }
  EXPECT_TRUE(until([&] { return app_->session().newest().tick.position_m > before_m + 0.001; }));
}

TEST_F(DemoInputTest, SaysWhenTheProbeIsAwayFromTheData) {
  open("mouse");
  EXPECT_FALSE(app_->shown().models.out_of_domain());
  app_->session().tool_input()->set_target(0.03, steady_now_s());  // the data of example models end at 6 mm
  EXPECT_TRUE(until([&] { return app_->shown().models.out_of_domain(); }));
}

// The pointer drives only after a press of the button on a block; the depth is the way from there.
TEST_F(DemoInputTest, PullingDownOnABlockTakesOverFromTheHand) {
  open("auto");
  point_at(384.0, 380.0);
  EXPECT_TRUE(app_->session().tool_input()->hand_is_exploring()) << "a movement alone presses nothing";
  left_button(GLFW_PRESS);
  ASSERT_TRUE(until([&] { return !app_->session().tool_input()->hand_is_exploring(); }));
  frames(30);
  const double high_m = app_->session().newest().tick.position_m;
  move_mouse(384.0, 480.0);
  ASSERT_TRUE(until([&] { return app_->session().newest().tick.position_m > high_m + 0.001; }));
  left_button(GLFW_RELEASE);
  EXPECT_TRUE(until([&] { return app_->session().newest().tick.position_m < 0.0; })) << "released";
}

// The window does not draw for 0.3 s. The loop still moves the probe at every tick.
TEST_F(DemoInputTest, AHeldKeyMovesTheProbeAtEveryTickOfTheLoop) {
  open("mouse");
  LiveSession& session = app_->session();
  const double before_s = session.newest().loop_time_s;
  const double before_m = session.newest().tick.position_m;
  hold(GLFW_KEY_DOWN, [&, frame = 0]() mutable {
    if (++frame == 3) std::this_thread::sleep_for(std::chrono::milliseconds(300));
    return frame == 5;
  });
  EXPECT_GT(session.newest().tick.position_m, before_m + 0.004) << "18 mm/s for 0.3 s, less the ramp";
  const ForceHistory& history = session.comparison().history();
  double fastest_m_per_s = 0.0;
  double last_m_per_s = 0.0;
  double jerk_m_per_s = 0.0;
  for (std::size_t i = history.first_at(before_s) + 1; i < history.size(); ++i) {
    const double step_s = history[i].loop_time_s - history[i - 1].loop_time_s;
    const auto step_m = static_cast<double>(history[i].position_m - history[i - 1].position_m);
    if (step_s > 2e-3) continue;  // missed ticks
    fastest_m_per_s = std::max(fastest_m_per_s, step_m / step_s);
    jerk_m_per_s = std::max(jerk_m_per_s, std::abs(step_m / step_s - last_m_per_s));
    last_m_per_s = step_m / step_s;
  }
  EXPECT_LT(fastest_m_per_s, 0.03);
  EXPECT_GT(fastest_m_per_s, 0.01);
  EXPECT_LT(jerk_m_per_s, 0.012) << "no step of the velocity from one tick to the next";
}

TEST_F(DemoInputTest, HeldKeysEndWhereTheDataEndAndJustAboveTheSurface) {
  open("mouse");
  LiveSession& session = app_->session();
  const double known_m = session.models().trained_depth_m();
  double began_s = session.newest().loop_time_s;
  double deepest_m = 0.0;
  hold(GLFW_KEY_DOWN, [&] {
    deepest_m = std::max(deepest_m, session.newest().tick.position_m);
    return session.newest().loop_time_s > began_s + 3.0;
  });
  EXPECT_LT(deepest_m, 1.15 * known_m);
  EXPECT_GT(deepest_m, 0.95 * known_m);
  began_s = session.newest().loop_time_s;
  hold(GLFW_KEY_UP, [&] { return session.newest().loop_time_s > began_s + 2.0; });
  EXPECT_NEAR(session.newest().tick.position_m, kHover_m, 1e-4);
}

// The key is pressed and released before the next frame is drawn.
TEST_F(DemoInputTest, ATapOfAKeyIsNotLostOnASlowFrame) {
  open("mouse");
  const double before_m = app_->session().newest().tick.position_m;
  press(GLFW_KEY_DOWN);
  EXPECT_TRUE(until([&] { return app_->session().newest().tick.position_m > before_m + 2e-5; }));
}

// Two rows of blocks: the tool does not let go where the pointer reaches the lower row, and not over the buttons.
TEST_F(DemoInputTest, OneStrokeDownIsOnePressThroughBothRows) {
  start(request("silicone_block", "mouse"));
  ASSERT_TRUE(until([&] { return app_->session().models().all_settled() && app_->shown().blocks.size() == 3; }));
  const double known_m = app_->session().models().trained_depth_m();
  point_at(384.0, 200.0);
  left_button(GLFW_PRESS);
  double last_m = -1.0;
  for (double y = 240.0; y <= 700.0; y += 40.0) {
    move_mouse(384.0, y, 25);
    EXPECT_GT(app_->session().newest().tick.position_m, last_m - 1e-4) << y;
    last_m = app_->session().newest().tick.position_m;
  }
  EXPECT_GT(last_m, 0.7 * known_m) << "the spring of the hand takes the rest";
  EXPECT_LT(last_m, 1.1 * known_m) << "a hard press ends where the data end";
  move_mouse(1000.0, 700.0, 20);
  EXPECT_GT(app_->session().newest().tick.position_m, 0.6 * known_m) << "until the button is released";
  left_button(GLFW_RELEASE);
  EXPECT_TRUE(until([&] { return app_->session().newest().tick.position_m < 0.0; }));
}

// A drag on the curves shows a moment of the past everywhere.
TEST_F(DemoInputTest, ADragOnTheCurvesMovesBlocksAndNumbers) {
  open("hand");
  ASSERT_TRUE(until([&] { return app_->session().comparison().history().size() > 3000; }));
  point_at(1000.0, 60.0);
  left_button(GLFW_PRESS, 4);
  const WindowView& shown = app_->shown();
  ASSERT_TRUE(shown.models.stands);
  const double at_s = shown.models.now.loop_time_s;
  EXPECT_LT(at_s, app_->session().newest().loop_time_s - 0.5);
  move_mouse(960.0, 60.0, 4);
  EXPECT_LT(app_->shown().models.now.loop_time_s, at_s) << "to the left is earlier";
  left_button(GLFW_RELEASE, 4);
  EXPECT_FALSE(app_->shown().models.stands) << "back to now";
  point_at(1180.0, 100.0);
  left_button(GLFW_PRESS, 4);
  EXPECT_TRUE(app_->shown().models.stands && app_->shown().models.now.in_contact) << "against depth: the nearest one";
}

}  // namespace
}  // namespace palpate
