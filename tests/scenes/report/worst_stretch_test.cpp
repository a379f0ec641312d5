#include "scenes/report/worst_stretch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models/model/fitted_model.h"
#include "tests/support/example_model.h"

namespace palpate {
namespace {

TEST(WorstStretch, IsWhereTheFirstModelErrs) {
  // 12 s; from 7 to 8 s the measured force is 50 N more than any model says.
  Recording recording = test::example_recording(12000, 1000.0);
  for (RecordingRow& row : recording.rows) {
    const double since_s = row.time_s - recording.rows.front().time_s;
    if (since_s >= 7.0 && since_s < 8.0) row.force_N += 50.0;
  }
  const auto model = std::make_shared<const FittedModel>(test::example_models().front());
  const WorstStretch worst = worst_stretch(recording, {model, model}, JndLine{});
  ASSERT_FALSE(worst.rows.empty());
  const double from_s = worst.rows.front().time_s - recording.rows.front().time_s;
  const double to_s = worst.rows.back().time_s - recording.rows.front().time_s;
  EXPECT_NEAR(to_s - from_s, kStretchSeconds, 2e-3);
  EXPECT_LE(from_s, 7.0);
  EXPECT_GE(to_s, 7.9);
  EXPECT_EQ(worst.rows[10].force_N.size(), 2u);
}

TEST(WorstStretch, OfAShortRecordingIsTheWhole) {
  const Recording recording = test::example_recording(500, 1000.0);
  const auto model = std::make_shared<const FittedModel>(test::example_models().front());
  EXPECT_EQ(worst_stretch(recording, {model}, JndLine{}).rows.size(), 500u);
}

}  // namespace
}  // namespace palpate
