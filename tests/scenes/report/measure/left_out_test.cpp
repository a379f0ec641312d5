#include "scenes/report/measure/left_out.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scenes/material/rig.h"
#include "tests/support/example_model.h"

namespace palpate {
namespace {

TEST(LeftOut, FoldsNeverTrainOnWhatTheyLeaveOut) {
  for (const std::size_t count : {1u, 2u, 4u}) {
    std::vector<SharedRecording> training;
    for (std::size_t i = 0; i < count; ++i) {
      training.push_back(std::make_shared<const Recording>(test::example_recording(3000, 1000.0)));
    }
    const auto folds = left_out_folds(training, 2);
    ASSERT_EQ(folds.size(), 2u) << count;
    for (const LeftOutFold& fold : folds) {
      ASSERT_FALSE(fold.train.empty());
      ASSERT_FALSE(fold.left_out.empty());
      for (const LeftOutPart& part : fold.left_out) {
        EXPECT_EQ(std::count(fold.train.begin(), fold.train.end(), part.recording), 0);
        if (count > 1) continue;
        // Of a single recording: what is trained on and what counts do not overlap in time.
        const auto& rows = fold.train.front()->rows;
        EXPECT_TRUE(rows.back().time_s < part.seconds.low || rows.front().time_s >= part.seconds.high);
      }
    }
  }
}

TEST(LeftOut, NothingOfAShortRecording) {
  const std::vector<SharedRecording> training{std::make_shared<const Recording>(test::example_recording(500, 1000.0))};
  EXPECT_TRUE(left_out_folds(training, 2).empty());
}

// A part of a recording begins on the dent of the last press, and its own onset of force
// says little: 1.6 mm off on the virtual silicone.
TEST(LeftOut, PartsLieAtTheSurfaceOfTheWhole) {
  RigSettings settings;
  settings.seconds = 30.0;
  const auto whole = record_sensors(settings);
  ASSERT_TRUE(whole.ok());
  Provenance provenance;
  provenance.surfaces.push_back({whole->name, 0.0003, 1e-5, 0.02});
  const auto moved = at_own_surfaces({std::make_shared<const Recording>(*whole)}, provenance);
  ASSERT_EQ(moved.size(), 1u);
  EXPECT_DOUBLE_EQ(moved[0]->rows[7].position_m, whole->rows[7].position_m - 0.0003);
  EXPECT_DOUBLE_EQ(moved[0]->rows[7].force_N, whole->rows[7].force_N - 0.02);
  const auto folds = left_out_folds(moved, 1);
  ASSERT_EQ(folds.size(), 1u);
  EXPECT_EQ(folds[0].left_out[0].recording->rows.size(), whole->rows.size());
}

}  // namespace
}  // namespace palpate
