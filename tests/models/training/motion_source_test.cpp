#include "models/training/motion_source.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/example_model.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using Input = MotionSource::Input;

Input in_memory(Recording recording) { return {"", prepare_recording(std::move(recording))}; }

std::vector<MotionRow> rows_of(MotionSource& source) {
  std::vector<MotionRow> rows;
  const Status status = source.for_each([&](const MotionRow& row) {
    rows.push_back(row);
    return true;
  });
  EXPECT_TRUE(status.ok());
  return rows;
}

std::vector<std::string> names_of(const MotionSource& source) {
  std::vector<std::string> names;
  for (const auto& recording : source.recordings()) names.push_back(recording.name);
  return names;
}

void expect_same(const std::vector<MotionRow>& a, const std::vector<MotionRow>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].sample.position_m, b[i].sample.position_m) << i;
    ASSERT_EQ(a[i].motion.position_m, b[i].motion.position_m) << i;
    ASSERT_EQ(a[i].motion.velocity_m_per_s, b[i].motion.velocity_m_per_s) << i;
    ASSERT_EQ(a[i].force_N, b[i].force_N) << i;
    ASSERT_EQ(a[i].stroke, b[i].stroke) << i;
    ASSERT_EQ(a[i].first, b[i].first) << i;
  }
}

// From memory, with the motion of prepare_recording, and from a file.
TEST(MotionSource, AFileGivesWhatMemoryGives) {
  // Longer than the rows used for sensor identification, and than one chunk of the reader.
  const Recording recording = test::example_recording(45000, 1000.0, 30e-6);
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_recording(folder.file("r.csv"), recording, {}, false).ok());
  const Input file{folder.file("r.csv"), nullptr};
  MotionSource read({file});
  MotionSource known({in_memory(recording)});
  expect_same(rows_of(read), rows_of(known));
  expect_same(rows_of(read), rows_of(known));  // a second pass
  EXPECT_EQ(read.rows(), 45000u);
  EXPECT_EQ(names_of(read), std::vector<std::string>{"r"});
  EXPECT_EQ(read.recordings()[0].hash, known.recordings()[0].hash);
  EXPECT_EQ(read.force_noise_N(), known.force_noise_N());

  // Two of them, with corrections.
  MotionSource twice({in_memory(recording), in_memory(recording)});
  MotionSource read_twice({file, file});
  for (MotionSource* source : {&twice, &read_twice}) source->correct({{1e-3, 0.5}, {0.0, 0.0}});
  for (int pass = 0; pass < 2; ++pass) expect_same(rows_of(read_twice), rows_of(twice));
}

TEST(MotionSource, RowsThatAreLeftOutAreARunUpOfTheOthers) {
  const Recording recording = test::example_recording(3000, 1000.0, 30e-6);
  MotionSource whole({in_memory(recording)});
  std::vector<bool> left_out(recording.rows.size(), false);
  std::fill(left_out.begin() + 1000, left_out.begin() + 2000, true);
  MotionSource source({{"", prepare_recording(recording, left_out)}});
  const auto rows = rows_of(source);
  expect_same(rows_of(whole), rows);
  for (std::size_t i = 0; i < rows.size(); ++i) ASSERT_EQ(rows[i].run_up, i >= 1000 && i < 2000) << i;
}

// A long recording is thinned: the rows are a subset in order, in stretches without gaps
// from the beginning to the end.
TEST(MotionSource, OfLongRecordingsKeepsTheBeginningAndStretches) {
  constexpr std::size_t kMost = 8000;
  const std::vector<Input> inputs{in_memory(test::example_recording(60000, 1000.0, 30e-6)),
                                  in_memory(test::example_recording(30000, 1000.0, 0.0))};
  MotionSource whole(inputs);
  MotionSource thinned(inputs, kMost);
  for (MotionSource* source : {&whole, &thinned}) source->correct({{1e-3, 0.5}, {0.0, 0.0}});
  const auto all = rows_of(whole);
  const auto rows = rows_of(thinned);
  EXPECT_EQ(names_of(thinned), names_of(whole));
  EXPECT_EQ(thinned.rows(), 90000u);
  EXPECT_EQ(thinned.force_noise_N(), whole.force_noise_N());
  EXPECT_LT(rows.size(), kMost + kMost / 10);
  EXPECT_GT(rows.size(), kMost / 2);
  constexpr std::size_t kSparse = 3 * 90000 / kMost + 1;
  std::size_t at = 0;
  std::size_t last = 0;
  std::size_t longest_gap = 0;
  std::vector<std::size_t> stretches(2, 0);
  bool run_up = true;
  for (const MotionRow& row : rows) {
    while (at < all.size() && (all[at].recording != row.recording || all[at].sample.time_s != row.sample.time_s)) ++at;
    ASSERT_LT(at, all.size());
    EXPECT_EQ(all[at].sample.position_m, row.sample.position_m);
    EXPECT_EQ(all[at].force_N, row.force_N);
    EXPECT_EQ(all[at].first, row.first);
    longest_gap = std::max(longest_gap, at - last);
    if (!run_up && !row.run_up && !row.first) {
      EXPECT_EQ(at, last + 1);
    }
    if (at < kMost / 8) {
      EXPECT_FALSE(row.run_up);
    }
    if ((run_up || row.first) && !row.run_up) ++stretches[static_cast<std::size_t>(row.recording)];
    run_up = row.run_up;
    last = at;
  }
  EXPECT_LE(longest_gap, kSparse);  // between stretches every kSparse-th row is kept
  EXPECT_LE(all.size() - last, kSparse);
  EXPECT_GE(stretches[0], 4u);
  EXPECT_GE(stretches[1], 2u);
}

TEST(MotionSource, CountsStrokesAndRecordings) {
  Recording recording;
  for (int i = 0; i < 40; ++i) {
    const bool pressed = i % 10 < 3 || i >= 38;  // five presses, the first from the beginning and the last to the end
    recording.rows.push_back({1e-3 * i, pressed ? 1e-3 : -1e-3, pressed ? 1.0 : 0.0, 0.0, 0.0});
  }
  MotionSource source({in_memory(recording), in_memory(recording)});
  const auto rows = rows_of(source);
  ASSERT_EQ(rows.size(), 80u);
  EXPECT_EQ(rows[0].stroke, 1);
  EXPECT_EQ(rows[39].stroke, 5);
  EXPECT_EQ(rows[40].stroke, 6) << "a stroke does not continue in the next recording";
  EXPECT_EQ(rows[79].stroke, 10);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].first, i % 40 == 0);
    EXPECT_EQ(rows[i].recording, i < 40 ? 0 : 1);
  }
}

// Contact and strokes are determined from the corrected position.
TEST(MotionSource, CorrectsPositionsAndForces) {
  Recording recording;
  for (int i = 0; i < 40; ++i) recording.rows.push_back({1e-3 * i, i % 10 >= 5 ? 1e-3 : -1e-3, 1.0, 0.0, 0.0});
  MotionSource source({in_memory(recording)});
  const auto before = rows_of(source);
  source.correct({{2e-3, 0.25}});
  const auto out = rows_of(source);
  EXPECT_EQ(out[5].sample.position_m, 1e-3 - 2e-3);
  EXPECT_EQ(out[5].motion.position_m, before[5].motion.position_m - 2e-3);
  EXPECT_EQ(out[5].motion.velocity_m_per_s, before[5].motion.velocity_m_per_s);
  EXPECT_EQ(out[5].force_N, 0.75);
  EXPECT_EQ(out.back().stroke, 0);
  source.correct({{-2e-3, 0.0}});
  EXPECT_EQ(rows_of(source).back().stroke, 1);
  source.correct({});
  expect_same(rows_of(source), before);
}

TEST(MotionSource, TheOrderOfInputsChangesNothing) {
  const test::TemporaryFolder folder;
  const Recording a = test::example_recording(2000, 1000.0, 30e-6);
  Recording b = a;
  for (RecordingRow& row : b.rows) row.force_N *= 2.0;
  const Recording c = test::example_recording(3000, 1000.0);
  ASSERT_TRUE(write_recording(folder.file("b.csv"), b, {}, false).ok());
  const Input file{folder.file("b.csv"), nullptr};
  MotionSource one({in_memory(a), file, in_memory(c)});
  MotionSource other({in_memory(c), in_memory(a), file});
  MotionSource files({file, in_memory(c), in_memory(a)}, 7000);
  const auto rows = rows_of(one);
  expect_same(rows_of(other), rows);
  expect_same(rows_of(files), rows);
  EXPECT_EQ(names_of(other), names_of(one));
  EXPECT_EQ(names_of(files), names_of(one));
}

TEST(MotionSource, APassThatBrokeOffLeavesNothingBehind) {
  MotionSource source({in_memory(test::example_recording(1000, 1000.0))});
  std::size_t seen = 0;
  const Status stopped = source.for_each([&](const MotionRow&) { return ++seen < 300; });
  ASSERT_FALSE(stopped.ok());
  EXPECT_EQ(stopped.error().message, "interrupted");
  EXPECT_EQ(rows_of(source).size(), 1000u);
  EXPECT_EQ(rows_of(source).size(), 1000u);
  EXPECT_EQ(source.rows(), 1000u);
}

TEST(MotionSource, AsksNowAndThenWhetherToGoOn) {
  MotionSource source({in_memory(test::example_recording(200000, 1000.0))});
  const FitControl stop{[](double) { return false; }};
  std::size_t seen = 0;
  const auto count = [&](const MotionRow&) { return ++seen > 0; };
  EXPECT_FALSE(source.for_each(count, stop).ok());  // during the first pass
  EXPECT_EQ(seen, 0u);
  int questions = 0;
  const FitControl on{[&](double fraction) { return ++questions > 0 && fraction == 0.5; }};
  ASSERT_TRUE(source.for_each(count, on, 0.5).ok());
  EXPECT_EQ(seen, 200000u);
  EXPECT_GE(questions, 6);
  seen = 0;
  EXPECT_FALSE(source.for_each(count, stop).ok());  // from the stored rows
  EXPECT_EQ(seen, kRowsPerQuestion);
}

TEST(MotionSource, AMissingFileIsTold) {
  MotionSource source({{"none.csv", nullptr}});
  const Status status = source.for_each([](const MotionRow&) { return true; });
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("none.csv"), std::string::npos);
}

}  // namespace
}  // namespace palpate
