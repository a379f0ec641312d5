#include "scenes/live/test_part.h"

#include <gtest/gtest.h>

#include "tests/support/example_model.h"

namespace palpate {
namespace {

TEST(TestPart, IsTheEndFromAMomentInAirOn) {
  const Recording whole = test::example_recording(5000, 1000.0);
  Recording rest = whole;
  const auto part = take_test_part(rest);
  ASSERT_TRUE(part.has_value());
  EXPECT_EQ(rest.rows.size() + part->rows.size(), whole.rows.size());
  EXPECT_GE(rest.rows.size(), 3000u);
  EXPECT_LE(rest.rows.size(), 4000u);
  EXPECT_LT(rest.rows.back().time_s, part->rows.front().time_s);
  EXPECT_LT(part->rows.front().position_m, 0.2e-3) << "not in the middle of a press";
  EXPECT_EQ(part->rows.front().force_N, 0.0);
  EXPECT_EQ(part->columns.velocity, whole.columns.velocity);
  EXPECT_EQ(part->name.rfind(whole.name + ", last ", 0), 0u) << part->name;
}

// One press that never leaves the block, and a recording at negative positions: the force decides, not the position.
TEST(TestPart, ExistsWithoutAirAndAtAnyZeroOfThePositions) {
  Recording held = test::example_recording(1000, 1000.0);
  for (RecordingRow& row : held.rows) row = {.time_s = row.time_s, .position_m = -0.1, .force_N = 2.0 - row.time_s};
  const auto part = take_test_part(held);
  ASSERT_TRUE(part.has_value());
  EXPECT_EQ(held.rows.size(), 799u) << "the row of least force";
}

TEST(TestPart, AShortRecordingStaysWhole) {
  Recording recording = test::example_recording(99, 1000.0);
  EXPECT_FALSE(take_test_part(recording).has_value());
  EXPECT_EQ(recording.rows.size(), 99u);
}

}  // namespace
}  // namespace palpate
