// The saved figure and the saved table contain the same samples.
#include "rendering/app/demo_app.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace palpate {
namespace {

// Two seconds of quick strokes; the model has exactly the reference's force.
ForceHistory example() {
  ForceHistory history;
  for (int i = 0; i < 2000; ++i) {
    HistoryPoint point;
    point.loop_time_s = point.time_s = 100.0 + 1e-3 * i;
    point.in_contact = true;
    point.force_N.fill(std::nanf(""));
    point.reference_N = point.force_N[0] = static_cast<float>(5.0 + std::sin(0.07 * i));
    history.append(point);
  }
  return history;
}

WindowView view_of(const ForceHistory& history) {
  WindowView shown;
  shown.history = &history;
  shown.reference_words = "truth";
  shown.models.slots.resize(1);
  shown.models.slots[0].name = "model";
  shown.models.slots[0].state = SlotState::ready;
  return shown;
}

const CurveTime kTime{.zero_s = 100.0, .shown_s = 2.0, .paused = true, .paused_at_s = 102.0};

TEST(SavedCurves, WhatIsEqualInTheTableIsEqualInTheFigure) {
  const ForceHistory history = example();
  CurveColumns columns;
  columns.gather(history, {}, 1, 100.0, 102.0, 100);
  const Plot plot = curve_plot(columns, view_of(history), kTime, "scene, hand");
  const std::vector<Series>& force = plot.panels.at(0).series;
  ASSERT_EQ(force.size(), 3u) << "band, reference, model";
  ASSERT_GT(force[1].rows.size(), 90u);
  for (std::size_t i = 0; i < force[1].rows.size(); ++i) {
    EXPECT_EQ(force[1].rows[i].y, force[2].rows[i].y);
    EXPECT_EQ(plot.panels.at(1).series.at(1).rows[i].y, 0.0);
    EXPECT_NEAR(force[0].rows[i].high - force[1].rows[i].y, JndLine{}.at(force[1].rows[i].y), 1e-6);
  }
}

TEST(SavedCurves, SaysWhatTheReferenceIs) {
  const ForceHistory history = example();
  std::istringstream csv(curve_csv(view_of(history), kTime, "scene, hand"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "# scene, hand; compared with: truth");
  std::getline(csv, line);
  EXPECT_EQ(line, "time_s,depth_m,reference_N,rendered_N,model_N");
  std::getline(csv, line);
  EXPECT_EQ(line, "0.000000,0,5,0,5");
}

}  // namespace
}  // namespace palpate
