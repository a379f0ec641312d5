#include "rendering/panels/window_view.h"

#include <gtest/gtest.h>

#include "rendering/panels/panel.h"
#include "rendering/ui/ui.h"

namespace palpate {
namespace {

TEST(CurveTime, ZoomsStopsAndGoesOn) {
  CurveTime time;
  EXPECT_DOUBLE_EQ(time.end_s(100.0), 100.0);
  time.zoom(98.0, 95.0);
  EXPECT_TRUE(time.paused);
  EXPECT_DOUBLE_EQ(time.end_s(200.0), 98.0);
  EXPECT_DOUBLE_EQ(time.shown_s, 3.0);
  time.scroll_back(50.0, 90.0);
  EXPECT_DOUBLE_EQ(time.end_s(200.0), 93.0) << "as far as there is history";
  time.zoom(1.0, 1.0);
  EXPECT_DOUBLE_EQ(time.shown_s, kLeastShown_s);
  time.run();
  EXPECT_DOUBLE_EQ(time.end_s(200.0), 200.0);
  EXPECT_DOUBLE_EQ(time.shown_s, kShown_s);
}

TEST(CurveTime, ADragShowsAMomentAndReturns) {
  CurveTime time;
  EXPECT_DOUBLE_EQ(time.at_s(100.0), 100.0);
  time.drag_to(97.0, 100.0);
  time.drag_to(96.0, 105.0);
  EXPECT_DOUBLE_EQ(time.at_s(110.0), 96.0);
  EXPECT_DOUBLE_EQ(time.end_s(110.0), 100.0) << "the curves stand still meanwhile";
  time.end_drag();
  EXPECT_DOUBLE_EQ(time.at_s(110.0), 110.0) << "now";
  time.pause(120.0);
  time.drag_to(115.0, 120.0);
  time.end_drag();
  EXPECT_DOUBLE_EQ(time.at_s(130.0), 120.0) << "stopped before, stopped after";
}

TEST(Layout, ThePanelIsBesideTheSceneOrBelowIt) {
  for (const ImVec2 window : {ImVec2(1280, 720), ImVec2(900, 600), ImVec2(800, 1050), ImVec2(2560, 1440)}) {
    const WindowLayout layout = lay_out(window);
    const float area = layout.scene.size.x * layout.scene.size.y + layout.panel.size.x * layout.panel.size.y;
    EXPECT_FLOAT_EQ(area, window.x * window.y) << "no gap, no overlap";
    EXPECT_GE(layout.panel.size.x, 350.0F) << window.x;
  }
  EXPECT_EQ(lay_out({800, 1050}).panel.at.x, 0.0F);
  EXPECT_GT(lay_out({900, 600}).panel.at.x, 0.0F);
}

TEST(UiScale, FollowsTheEyeAndNotThePixels) {
  const float usual = ui_scale({1280, 720, 1.0F, 1.0F}, 1.0F);
  EXPECT_NEAR(usual, 0.78F, 0.03F);
  EXPECT_FLOAT_EQ(ui_scale({1280, 720, 2.0F, 2.0F}, 1.0F), usual) << "a display with twice the pixels in each unit";
  EXPECT_FLOAT_EQ(ui_scale({2560, 1440, 2.0F, 1.0F}, 1.0F), 2.0F * usual) << "one that counts in pixels";
  EXPECT_NEAR(ui_scale({1920, 1080, 1.0F, 1.0F}, 1.0F), 1.0F, 1e-5F);
  EXPECT_FLOAT_EQ(ui_scale({800, 1050, 1.0F, 1.0F}, 1.0F), usual) << "narrow";
  // The scale goes in steps of 0.04.
  EXPECT_NEAR(ui_scale({1920, 1080, 1.0F, 1.0F}, kExhibitText), 1.5F, 0.021F);
}

TEST(ModelTable, DropsColumnsInAFixedOrder) {
  const auto width = [](int) { return 10.0F; };
  EXPECT_EQ(shown_columns(100.0F, width), (std::vector<int>{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(shown_columns(65.0F, width), (std::vector<int>{0, 1, 3, 4, 5, 6})) << "millinewtons first";
  EXPECT_EQ(shown_columns(45.0F, width), (std::vector<int>{0, 3, 4, 5}));
  EXPECT_EQ(shown_columns(1.0F, width), (std::vector<int>{0, 3, 5})) << "name, error and speed stay";
}

}  // namespace
}  // namespace palpate
