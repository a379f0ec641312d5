#include "scenes/live/session_recorder.h"

#include <gtest/gtest.h>

#include "engine/base/text.h"
#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

std::string rows(const char* header, const char* between) {
  std::string text = std::string(header) + "\n";
  for (int i = 0; i < 50; ++i) {
    const double at = 0.01 * i;
    text += std::to_string(at) + between + std::to_string(at) + between + std::to_string(2.0 * at) + "\n";
  }
  return text;
}

TEST(ConvertedRecording, ARecordingStaysAsItIs) {
  const test::TemporaryFolder folder;
  const std::string path = folder.with_file("a.csv", rows("time_s,position_m,force_N", ","));
  const auto converted = test::must(convert_recording(path, folder.path()));
  EXPECT_EQ(converted.path, path);
  EXPECT_TRUE(converted.words.empty());
}

TEST(ConvertedRecording, AnotherTableBecomesOneInTheFolder) {
  const test::TemporaryFolder folder;
  const test::TemporaryFolder data;
  const std::string path = folder.with_file("trial.txt", rows("Time [s]\tPosition [mm]\tForce [mN]", "\t"));
  const auto converted = test::must(convert_recording(path, data.path()));
  EXPECT_EQ(converted.path.rfind(data.path() + "/trial-", 0), 0u) << converted.path;
  EXPECT_TRUE(test::has_parts(joined(converted.words, "\n"), {"\nposition: column 2 \"Position [mm]\" in mm"}));
  EXPECT_NEAR(test::must(read_recording(converted.path)).rows.back().force_N, 0.98e-3, 1e-9);
}

TEST(ConvertedRecording, ErrorsNameTheKindOfTheFile) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(test::has_parts(
      convert_recording(folder.with_file("a.csv", "# mine\ntime_s,position_m,force_N\n0,0,x\n"), folder.path()),
      {"a.csv:3"}));
  EXPECT_TRUE(test::has_parts(
      convert_recording(folder.with_file("b.csv", "t [s],x [mm],F1 [N],F2 [N]\n0,1,2,3\n1,2,3,4\n2,3,4,5\n3,4,5,6\n"),
                        folder.path()),
      {"--columns"}));
  EXPECT_FALSE(convert_recording(folder.file("none.csv"), folder.path()).ok());
}

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
