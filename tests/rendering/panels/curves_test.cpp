#include "rendering/panels/time_plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scenes/live/comparison.h"

namespace palpate {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

// A second of ticks from 100 s on: the reference 1 N, slot 0 at 1.1 N with one
// peak of 3 N, slot 1 not ready in the first half.
ForceHistory example() {
  ForceHistory history;
  SustainedError sustained;
  for (int i = 0; i < 1000; ++i) {
    HistoryPoint point;
    point.loop_time_s = point.time_s = 100.0 + 1e-3 * i;
    point.in_contact = true;
    point.reference_N = 1.0F;
    point.force_N.fill(kNone);
    point.sustained_over_jnd.fill(kNone);
    point.force_N[0] = i == 333 ? 3.0F : 1.1F;
    if (i >= 500) point.force_N[1] = 0.9F;
    point.sustained_over_jnd[0] =
        static_cast<float>(sustained.add(point.time_s, point.difference_over_jnd(0, JndLine{})));
    history.append(point);
  }
  return history;
}

TEST(CurveColumns, LoseNoPeakAndKeepGapsOpen) {
  const ForceHistory history = example();
  CurveColumns curves;
  const JndLine jnd;
  curves.gather(history, jnd, 2, 100.0, 101.0, 50);
  ASSERT_GE(curves.columns().size(), 50u);
  EXPECT_FLOAT_EQ(curves.highest_force_N(), 3.0F);
  int ready = 0;
  float largest_over_jnd = 0.0F;
  for (const CurveColumn& column : curves.columns()) {
    if (!column.any) continue;
    largest_over_jnd = std::fmax(largest_over_jnd, column.high_over_jnd[0]);
    largest_over_jnd = std::fmax(largest_over_jnd, column.high_over_jnd[1]);
    EXPECT_FLOAT_EQ(column.low_over_jnd[0], static_cast<float>(0.1 / jnd.at(1.0)));
    EXPECT_FLOAT_EQ(column.jnd_N, static_cast<float>(jnd.at(1.0)));
    if (!std::isnan(column.tick.force_N[1])) ++ready;
    EXPECT_EQ(std::isnan(column.tick.force_N[1]), std::isnan(column.high_over_jnd[1]));
  }
  EXPECT_NEAR(ready, 25, 1);
  EXPECT_FLOAT_EQ(largest_over_jnd, static_cast<float>(2.0 / jnd.at(1.0)));
}

// Gathering in every frame, as the window does, equals gathering at once.
TEST(CurveColumns, ScrollingGivesWhatAFreshStartGives) {
  ForceHistory growing;
  CurveColumns scrolled;
  const ForceHistory all = example();
  for (std::size_t i = 0; i < all.size(); ++i) {
    growing.append(all[i]);
    if (i % 17 == 0 || i + 1 == all.size()) {
      const double end_s = all[i].loop_time_s;
      scrolled.gather(growing, {}, 2, end_s - 0.5, end_s, 40);
    }
  }
  const double end_s = all[all.size() - 1].loop_time_s;
  CurveColumns fresh;
  fresh.gather(all, {}, 2, end_s - 0.5, end_s, 40);
  ASSERT_EQ(scrolled.columns().size(), fresh.columns().size());
  for (std::size_t i = 0; i < fresh.columns().size(); ++i) {
    const CurveColumn& a = scrolled.columns()[i];
    const CurveColumn& b = fresh.columns()[i];
    EXPECT_EQ(a.any, b.any) << i;
    EXPECT_DOUBLE_EQ(a.time_s, b.time_s);
    if (!a.any || i == 0) continue;  // the start of the first column may have left the history
    EXPECT_EQ(a.tick.loop_time_s, b.tick.loop_time_s) << i;
  }
}

TEST(CurveColumns, WithoutAReferenceTheActiveModelPredictsItsError) {
  HistoryPoint point;
  point.in_contact = true;
  point.reference_N = kNone;
  point.predicted_error_N = 0.3F;
  EXPECT_FLOAT_EQ(static_cast<float>(predicted_error_N(point)), 0.3F);
  point.reference_N = 1.0F;
  EXPECT_TRUE(std::isnan(predicted_error_N(point))) << "a reference is better";
  point.reference_N = kNone;
  point.in_contact = false;
  EXPECT_EQ(predicted_error_N(point), 0.0) << "out of contact there is no force to be wrong about";
}

}  // namespace
}  // namespace palpate
