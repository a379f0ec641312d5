#include "scenes/report/recordings.h"

#include <gtest/gtest.h>

#include "engine/base/random_stream.h"
#include "engine/recording/recording.h"
#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

// The example recording with independent sensor noise.
Recording noisy(const std::string& name, std::uint64_t seed, std::size_t rows = 2000) {
  Recording recording = test::example_recording(rows, 1000.0);
  recording.name = name;
  RandomStream random(seed, 0);
  for (RecordingRow& row : recording.rows) row.force_N += 0.005 * random.normal();
  return recording;
}

// The first recording is the training recording.
Status refuse(const std::vector<Recording>& recordings) {
  std::vector<SharedRecording> all;
  for (const Recording& one : recordings) all.push_back(std::make_shared<const Recording>(one));
  return refuse_leakage(all, 1);
}

TEST(Leakage, TheSameMotionWithItsOwnNoiseIsNoLeak) {
  const Recording train = noisy("train", 1);
  const Recording test = noisy("test", 2);
  EXPECT_EQ(shared_stretch(train, test).rows, 0u);
  EXPECT_TRUE(refuse({train, test}).ok());
  EXPECT_NE(content_hash(train), content_hash(test));
}

TEST(Leakage, ACopyUnderAnotherNameIsRefusedByName) {
  const Recording train = noisy("train", 1);
  Recording copy = train;
  copy.name = "copy";
  for (RecordingRow& row : copy.rows) row.time_s += 100.0;
  const std::vector<std::string> parts = {"copy", "2000 rows", "0 s", "train", "0 s", "; "};
  const Status status = refuse({train, copy});
  ASSERT_FALSE(status);
  EXPECT_TRUE(test::has_parts(status.error().message, parts));
  const auto both = {std::make_shared<const Recording>(train), std::make_shared<const Recording>(copy)};
  EXPECT_TRUE(test::has_parts(refuse_leakage(both, 2).error().message, parts)) << "without a test they test each other";
}

TEST(Leakage, AStretchOfTheTrainingInATestIsFoundWhereverItLies) {
  const Recording train = noisy("train", 1);
  Recording test = noisy("test", 2);
  // A shared stretch of 2 kLeakRows - 1 rows or more is always found, a shorter one not always.
  for (std::size_t i = 0; i < 2 * kLeakRows; ++i) test.rows[777 + i].force_N = train.rows[331 + i].force_N;
  const SharedStretch stretch = shared_stretch(train, test);
  EXPECT_EQ(stretch.rows, 2 * kLeakRows);
  EXPECT_EQ(stretch.first_row, 777u);
  EXPECT_EQ(stretch.trained_row, 331u);
  const Status status = refuse({train, test});
  ASSERT_FALSE(status);
  EXPECT_TRUE(test::has_parts(status.error().message, {"100", "0.777 s", "0.331 s"})) << status.error().message;
}

TEST(Leakage, AShiftOfThePositionsHidesNothing) {
  const Recording train = noisy("train", 1);
  Recording shifted = train;
  shifted.name = "shifted";
  for (RecordingRow& row : shifted.rows) row.position_m += 0.0003;
  EXPECT_EQ(shared_stretch(train, shifted).rows, train.rows.size());
}

TEST(Leakage, SilenceIsNoContent) {
  Recording train = noisy("train", 1);
  Recording test = noisy("test", 2);
  for (Recording* recording : {&train, &test}) {
    for (std::size_t i = 0; i < 500; ++i) recording->rows[i].force_N = 0.0;
  }
  EXPECT_EQ(shared_stretch(train, test).rows, 0u);
}

}  // namespace
}  // namespace palpate
