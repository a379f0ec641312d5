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

}  // namespace
}  // namespace palpate
