#include "scenes/report/recordings.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <set>

#include "engine/base/random_stream.h"
#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

class ReportRecordings : public ::testing::Test {
 protected:
  std::string recording(const std::string& name, std::size_t rows = 1000) const {
    const std::string path = folder_.file(name + ".csv");
    // Each name has independent noise, because a copy would be refused.
    Recording recording = test::example_recording(rows, 1000.0);
    RandomStream random(std::hash<std::string>{}(name), 0);
    for (RecordingRow& row : recording.rows) row.force_N += 0.005 * random.normal();
    EXPECT_TRUE(write_recording(path, recording, {}, false).ok());
    return path;
  }
  static Result<RecordingSet> load(const std::vector<std::string>& train, const std::vector<std::string>& test) {
    std::vector<SharedRecording> read[2];
    for (const std::string& path : train) read[0].push_back(std::make_shared<const Recording>(*read_recording(path)));
    for (const std::string& path : test) read[1].push_back(std::make_shared<const Recording>(*read_recording(path)));
    return split_recordings(read[0], read[1]);
  }

  static std::multiset<std::string> names(const std::vector<SharedRecording>& recordings) {
    std::multiset<std::string> names;
    for (const SharedRecording& one : recordings) names.insert(one->name);
    return names;
  }

  test::TemporaryFolder folder_;
};

TEST_F(ReportRecordings, TrainAndTestStayApart) {
  const auto set = load({recording("a"), recording("b")}, {recording("c")});
  ASSERT_TRUE(set.ok()) << set.error().message;
  ASSERT_EQ(set->folds.size(), 1u);
  EXPECT_EQ(names(set->folds[0].train), (std::multiset<std::string>{"a", "b"}));
  EXPECT_EQ(names(set->folds[0].tested), (std::multiset<std::string>{"c"}));
  EXPECT_EQ(set->folds[0].words, "");
  EXPECT_EQ(set->facts[2].role, "test");
  EXPECT_EQ(set->facts[2].name, "c");
  EXPECT_EQ(set->facts[2].samples, 1000u);
  EXPECT_NEAR(set->facts[2].rate_Hz, 1000.0, 1e-6);
}

TEST_F(ReportRecordings, WithoutATestEveryRecordingIsTestedOnceByTheOthers) {
  std::vector<std::string> paths;
  for (const char* name : {"a", "b", "c", "d", "e", "f", "g"}) paths.push_back(recording(name));
  const auto set = load(paths, {});
  ASSERT_TRUE(set.ok()) << set.error().message;
  ASSERT_EQ(set->folds.size(), kMostFolds);
  std::multiset<std::string> tested;
  for (const Split& fold : set->folds) {
    EXPECT_TRUE(test::has_parts(fold.words, {"5-fold"}));
    EXPECT_EQ(fold.train.size() + fold.tested.size(), paths.size());
    tested.merge(names(fold.tested));
    for (const SharedRecording& one : fold.tested) {
      EXPECT_EQ(std::count(fold.train.begin(), fold.train.end(), one), 0);
    }
  }
  EXPECT_EQ(tested, (std::multiset<std::string>{"a", "b", "c", "d", "e", "f", "g"}));
}

TEST_F(ReportRecordings, OfASingleOneABlockAtItsEndIsTested) {
  const auto set = load({recording("a", 3000)}, {});
  ASSERT_TRUE(set.ok()) << set.error().message;
  ASSERT_EQ(set->folds.size(), 1u);
  const Split& fold = set->folds.front();
  ASSERT_EQ(fold.train.size(), 1u);
  EXPECT_NEAR(fold.train[0]->rows.back().time_s + 1e-3, fold.counted_from_s, 1e-9) << "the next row";
  EXPECT_TRUE(test::has_parts(fold.words, {"block at the end"}));
  EXPECT_EQ(fold.tested[0]->rows.size(), 3000u);
  ASSERT_EQ(set->facts.size(), 1u);
  EXPECT_EQ(set->facts[0].role, "both");
}

TEST_F(ReportRecordings, TheirOrderDoesNotMatter) {
  const std::string a = recording("a");
  const std::string b = recording("b");
  const std::string c = recording("c");
  const auto one = load({a, b}, {c});
  const auto other = load({b, a}, {c});
  ASSERT_TRUE(one.ok() && other.ok());
  for (std::size_t i = 0; i < one->facts.size(); ++i) {
    EXPECT_EQ(one->facts[i].name, other->facts[i].name);
    EXPECT_EQ(one->facts[i].content_hash, other->facts[i].content_hash);
  }
}

TEST_F(ReportRecordings, RefusesUnusableRecordings) {
  const std::string a = recording("a");
  auto set = load({recording("short", 100)}, {});
  ASSERT_FALSE(set.ok());
  EXPECT_TRUE(test::has_parts(set.error().message, {"100", "1000", "--test"}));
  Recording air = test::example_recording(100, 1000.0);
  for (RecordingRow& row : air.rows) row.position_m = -1e-3 - 1e-6 * row.time_s;
  ASSERT_TRUE(write_recording(folder_.file("air.csv"), air, {}, false).ok());
  set = load({a}, {folder_.file("air.csv")});
  ASSERT_FALSE(set.ok());
  EXPECT_TRUE(test::has_parts(set.error().message, {"position_m", "0", "position_m"}));
}

}  // namespace
}  // namespace palpate
