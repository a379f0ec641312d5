#include "models/samples/sample.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/example_model.h"

namespace palpate {
namespace {

TEST(ThinnedRows, AreEvenlySpacedOverTheWholeWithTheMotionOfAllRows) {
  const Recording recording = test::example_recording(1000, 1000.0);
  const std::vector<Sample> all = thinned_rows(recording, kAllRows), few = thinned_rows(recording, 99);
  ASSERT_EQ(all.size(), 1000u);
  EXPECT_LE(few.size(), 99u);
  EXPECT_GT(few.back().tool.time_s, 0.98 * all.back().tool.time_s);
  for (const Sample& row : few) {
    const auto same = std::ranges::find(all, row.tool.time_s, [](const Sample& one) { return one.tool.time_s; });
    ASSERT_NE(same, all.end());
    EXPECT_EQ(row.motion.velocity_m_per_s, same->motion.velocity_m_per_s);
  }
}

}  // namespace
}  // namespace palpate
