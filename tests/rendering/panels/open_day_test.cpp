// The exhibit as visitors use it.
#include "rendering/panels/open_day.h"

#include "tests/support/demo_window.h"

namespace palpate {
namespace {

using OpenDayTest = test::DemoWindowTest;

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
