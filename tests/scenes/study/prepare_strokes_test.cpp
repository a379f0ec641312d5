#include "scenes/study/prepare_strokes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/live_doubles.h"
#include "tests/support/message_parts.h"
#include "tests/support/study_driving.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::spring;

// Presses of `depths_m`, 1.2 s each with pauses of 1.2 s, into a spring of 100 N/m. In the last
// press the measured force is too high by `offset_N`.
Recording presses(const std::vector<double>& depths_m, double offset_N, double rate_Hz = 1000.0) {
  Recording recording;
  recording.name = "spring";
  const double pi = std::acos(-1.0);
  for (std::size_t i = 0; static_cast<double>(i) / rate_Hz < 2.4 * static_cast<double>(depths_m.size()); ++i) {
    RecordingRow row;
    row.time_s = static_cast<double>(i) / rate_Hz;
    const auto press = std::min(static_cast<std::size_t>(row.time_s / 2.4), depths_m.size() - 1);
    const double phase = (row.time_s - 2.4 * static_cast<double>(press)) / 1.2;
    row.position_m = phase < 1.0 ? depths_m[press] * std::pow(std::sin(pi * phase), 2) : -0.001;
    if (row.position_m > 0.0) row.force_N = 100.0 * row.position_m + (press + 1 == depths_m.size() ? offset_N : 0.0);
    recording.rows.push_back(row);
  }
  return recording;
}

TEST(PrepareStrokes, TakesTheStrokeThatDiffersMost) {
  const JndLine jnd{0.1, 0.0};
  const StrokePair pair = *test::must(strokes_of(presses({0.02, 0.01, 0.01}, 0.05), nullptr, spring(100.0), jnd));
  EXPECT_EQ(pair.reference, "recorded force");
  EXPECT_EQ(pair.comparison, "spring");
  EXPECT_EQ(pair.recording, "spring");
  EXPECT_GT(pair.from_s, 4.8 - 1.1) << "of the third press";
  EXPECT_LT(pair.from_s, 6.0);
  EXPECT_NEAR(pair.max_over_jnd, 0.5, 0.01);
  EXPECT_GT(pair.mean_over_jnd, 0.3);
  ASSERT_EQ(pair.reference_N.size(), kInterval_ticks);
  EXPECT_NEAR(*std::max_element(pair.comparison_N.begin(), pair.comparison_N.end()), 1.0, 0.01);
  EXPECT_NEAR(pair.reference_mean_N - pair.comparison_mean_N, 0.05, 0.005);
}

TEST(PrepareStrokes, TwoModelsDifferByTheirStiffness) {
  const JndLine jnd{0.1, 0.0};
  const auto strokes = test::must(strokes_of(presses({0.01}, 7.0), spring(100.0), spring(80.0), jnd));
  EXPECT_EQ(strokes->reference, "spring");
  EXPECT_NEAR(strokes->max_over_jnd, 2.0, 0.02) << "0.2 N at 1 N; what was recorded does not count";
  const auto same = strokes_of(presses({0.01}, 7.0), spring(100.0), spring(100.0), jnd);
  EXPECT_EQ((*same)->max_over_jnd, 0.0);
  EXPECT_EQ((*same)->reference_N, (*same)->comparison_N);
  EXPECT_NE((*same)->checksum, strokes->checksum);
}

TEST(PrepareStrokes, DoesNotDependOnTheRate) {
  const JndLine jnd;
  const auto slow = strokes_of(presses({0.01}, 0.0, 200.0), spring(100.0), spring(80.0), jnd);
  const auto fast = strokes_of(presses({0.01}, 0.0, 4000.0), spring(100.0), spring(80.0), jnd);
  ASSERT_TRUE(slow.ok() && fast.ok());
  EXPECT_NEAR((*slow)->max_over_jnd, (*fast)->max_over_jnd, 0.01);
  EXPECT_NEAR((*slow)->reference_mean_N, (*fast)->reference_mean_N, 0.02);
}

TEST(PrepareStrokes, ExcludesStrokesBeyondTheLimits) {
  const JndLine jnd;
  const auto weak = test::must(strokes_of(presses({0.06, 0.01}, 0.0), spring(100.0), spring(80.0), jnd));
  for (std::uint32_t i = 0; i < kInterval_ticks; ++i) {
    ASSERT_LE(weak->reference_N[i] * interval_share(i), 0.95 * kLargestStudyForce_N);
  }
  EXPECT_TRUE(test::has_parts(strokes_of(presses({-0.01}, 0.0), spring(100.0), spring(80.0), jnd),
                              {"1.1 s", "3.8 N", "2.5 N", "90 N/s", "spring", "; "}));
}

TEST(PrepareStrokes, CanBePresentedAsTheyAre) {
  const auto strokes = test::must(strokes_of(presses({0.03, 0.035}, 0.0), spring(100.0), spring(95.0), {}));
  const test::TemporaryFolder folder;
  const auto session = test::must(test::session_at(folder.file("S01.csv"), {"S01", strokes}));
  session->accept_consent("");
  EXPECT_EQ(test::answer_trials(*session, 1000, test::truly_like), 104u);
  for (const StudyRecord& record : session->file().records()) {
    EXPECT_FALSE(record.limited);
    EXPECT_EQ(record.worst_N, 0.0);
  }
}

TEST(PrepareStrokes, RefusesOtherNumbersOfModels) {
  EXPECT_TRUE(
      test::has_parts(prepare_strokes("silicone_block", {"greedy", "random", "direct"}, ""), {"found 3 models"}));
  EXPECT_TRUE(test::has_parts(prepare_strokes("silicone_block", {"best"}, ""), {"\"best\""}));
  EXPECT_TRUE(test::has_parts(prepare_strokes("jnd_study", {}, ""), {"has no virtual material"}));
  EXPECT_TRUE(test::has_parts(prepare_strokes("silicone_block", {}, "/none/rec.csv"), {"/none/rec.csv"}));
}

}  // namespace
}  // namespace palpate
