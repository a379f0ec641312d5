#include "scenes/report/recordings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>

#include "engine/base/random_stream.h"
#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

using Names = std::multiset<std::string>;

// The example recording with sensor noise that is the name's own, because a copy would be refused.
Recording noisy(const std::string& name, std::size_t rows = 1000) {
  Recording recording = test::example_recording(rows, 1000.0);
  recording.name = name;
  RandomStream random(std::hash<std::string>{}(name), 0);
  for (RecordingRow& row : recording.rows) row.force_N += 0.005 * random.normal();
  return recording;
}

std::vector<PreparedRecordingPointer> prepared(const std::vector<Recording>& recordings) {
  std::vector<PreparedRecordingPointer> all;
  for (const Recording& one : recordings) all.push_back(prepare_recording(one));
  return all;
}

Result<RecordingSet> split(const std::vector<Recording>& train, const std::vector<Recording>& test) {
  return split_recordings(prepared(train), prepared(test));
}

Names names(const std::vector<PreparedRecordingPointer>& recordings) {
  Names names;
  for (const PreparedRecordingPointer& one : recordings) names.insert(one->recording.name);
  return names;
}

TEST(ReportRecordings, TrainAndTestStayApart) {
  const auto set = test::must(split({noisy("a"), noisy("b")}, {noisy("c")}));
  ASSERT_EQ(set.folds.size(), 1u);
  EXPECT_EQ(names(set.folds[0].train), (Names{"a", "b"}));
  EXPECT_EQ(names(set.folds[0].tested), (Names{"c"}));
  EXPECT_EQ(set.folds[0].words, "");
  EXPECT_EQ(set.trained, 2u);
  EXPECT_TRUE(set.is_tested(2));
  EXPECT_FALSE(set.is_tested(1));
  EXPECT_EQ(set.all[2]->recording.name, "c");
}

TEST(ReportRecordings, WithoutATestEveryRecordingIsTestedOnceByTheOthers) {
  std::vector<Recording> recordings;
  for (const char* name : {"a", "b", "c", "d", "e", "f", "g"}) recordings.push_back(noisy(name));
  const auto set = test::must(split(recordings, {}));
  ASSERT_EQ(set.folds.size(), kMostFolds);
  Names tested;
  for (const Split& fold : set.folds) {
    EXPECT_TRUE(test::has_parts(fold.words, {"5-fold"}));
    EXPECT_EQ(fold.train.size() + fold.tested.size(), recordings.size());
    tested.merge(names(fold.tested));
    for (const PreparedRecordingPointer& one : fold.tested) {
      EXPECT_EQ(std::count(fold.train.begin(), fold.train.end(), one), 0);
    }
  }
  EXPECT_EQ(tested, (Names{"a", "b", "c", "d", "e", "f", "g"}));
  EXPECT_EQ(names(set.folds[0].tested), (Names{"a", "f"})) << "recordings with similar names are in other folds";
}

TEST(ReportRecordings, OfASingleOneABlockAtItsEndIsTested) {
  const auto set = test::must(split({noisy("a", 3000)}, {}));
  ASSERT_EQ(set.folds.size(), 1u);
  const Split& fold = set.folds.front();
  ASSERT_EQ(fold.train.size(), 1u);
  EXPECT_NEAR(fold.train[0]->recording.rows.back().time_s + 1e-3, fold.counted_from_s, 1e-9) << "the next row";
  EXPECT_TRUE(test::has_parts(fold.words, {"block at the end"}));
  EXPECT_EQ(fold.tested[0]->recording.rows.size(), 3000u);
  ASSERT_EQ(set.all.size(), 1u);
  EXPECT_EQ(set.trained, 1u);
  EXPECT_TRUE(set.is_tested(0)) << "by a fit to the rest of it";
}

TEST(ReportRecordings, RefusesUnusableRecordings) {
  EXPECT_TRUE(test::has_parts(split({noisy("short", 100)}, {}), {"100 rows", "1000", "--test"}));
  Recording air = noisy("air", 100);
  for (RecordingRow& row : air.rows) row.position_m = -1e-3 - 1e-6 * row.time_s;
  EXPECT_TRUE(test::has_parts(split({noisy("a")}, {air}), {"air: ", "position_m > 0", "; "}));
}

TEST(Leakage, ACopyUnderAnotherNameIsRefusedByName) {
  const Recording train = noisy("train");
  Recording copy = train;
  copy.name = "copy";
  for (RecordingRow& row : copy.rows) {
    row.time_s += 100.0;
    row.position_m += 0.0003;
  }
  const std::vector<std::string> parts = {"copy: ", "1000 rows from 0 s", "train from 0 s", "; "};
  EXPECT_TRUE(test::has_parts(split({train}, {copy}), parts));
  EXPECT_TRUE(test::has_parts(split({copy, train}, {}), {"train: ", "copy from 0 s"}))
      << "without a test they test each other";
}

TEST(Leakage, AStretchOfTheTrainingInATestIsFoundWhereverItLies) {
  const Recording train = noisy("train");
  Recording test = noisy("test");
  // A shared stretch of 2 kLeakRows - 1 rows or more is always found, a shorter one not always.
  for (std::size_t i = 0; i < 2 * kLeakRows; ++i) test.rows[777 + i].force_N = train.rows[331 + i].force_N;
  const SharedStretch stretch = shared_stretch(train, test);
  EXPECT_EQ(stretch.rows, 2 * kLeakRows);
  EXPECT_EQ(stretch.first_row, 777u);
  EXPECT_EQ(stretch.trained_row, 331u);
  EXPECT_TRUE(palpate::test::has_parts(split({train}, {test}), {"100 rows from 0.777 s", "0.331 s"}));
}

}  // namespace
}  // namespace palpate
