#include "scenes/study/study_figure.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace palpate {
namespace {

StudyAnalysis example() {
  StudyAnalysis analysis;
  analysis.subjects.push_back({"S01", 0, {{0.3, 0.3, 80, 0.09, 0.0, true}, {2.5, 2.5, 80, 0.4, 0.0, false}}});
  analysis.points = {
      {0.3, 0.09, 0.01, "study"}, {2.5, 0.3, 0.02, "study"}, {2.5, 0.225, 0.0, "Pang, Tan & Durlach (1991)"}};
  analysis.lines = JndLines{{0.07, 0.08}, {0.065, 0.08}};
  return analysis;
}

const Series* find(const Panel& panel, const std::string& name) {
  const auto at = std::find_if(panel.series.begin(), panel.series.end(),
                               [&](const Series& series) { return series.name.rfind(name, 0) == 0; });
  return at == panel.series.end() ? nullptr : &*at;
}

TEST(StudyFigure, HoldsPointsAndLinesAsTheyAreAndInPerCent) {
  const Plot plot = study_plot(example());
  ASSERT_EQ(plot.panels.size(), 2u);
  const Panel &a = plot.panels[0], &b = plot.panels[1];
  for (const char* name : {"Hoever & Harders (2009): 0.065 N + 6.33 %", "fitted: 0.070 N + 8.00 %",
                           "conservative: 0.065 N + 8.00 %", "single subjects", "mean", "Pang"}) {
    ASSERT_NE(find(a, name), nullptr) << name;
    ASSERT_NE(find(b, name), nullptr) << name;
  }
  ASSERT_EQ(find(a, "single")->rows.size(), 1u) << "only what is determined";
  EXPECT_NEAR(find(b, "single")->rows[0].y, 30.0, 1e-9);
  ASSERT_EQ(find(a, "mean")->rows.size(), 2u);
  EXPECT_NEAR(find(a, "mean")->rows[0].low, 0.08, 1e-12);
  EXPECT_NEAR(find(b, "mean")->rows[0].high, 100.0 / 3.0, 1e-9);
  EXPECT_NEAR(find(b, "Pang")->rows[0].y, 9.0, 1e-9);
  for (const PlotRow& row : find(b, "Hoever")->rows) EXPECT_NEAR(row.y, 100.0 * (0.065 / row.x + 0.0633), 1e-9);
}

TEST(StudyFigure, WithoutALineThereAreStillThePoints) {
  StudyAnalysis analysis = example();
  analysis.lines = Error{"none"};
  const Plot plot = study_plot(analysis);
  EXPECT_EQ(find(plot.panels[0], "fitted"), nullptr);
  EXPECT_EQ(find(plot.panels[0], "mean")->rows.size(), 2u);
}

}  // namespace
}  // namespace palpate
