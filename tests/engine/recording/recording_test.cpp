#include "engine/recording/recording.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <clocale>
#include <cstring>
#include <filesystem>
#include <random>

#include "engine/base/text.h"
#include "tests/support/broken_recordings.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::TemporaryFolder;

// Reads `text` as a file; fails the test if it is refused.
Recording accepted(const std::string& text) {
  const TemporaryFolder folder;
  const std::string path = folder.with_file("rec.csv", text);
  auto recording = read_recording(path);
  EXPECT_TRUE(recording.ok()) << recording.error().message;
  std::vector<double> times_s;  // in blocks
  const auto use = [&](const Recording& block) {
    for (const RecordingRow& row : block.rows) times_s.push_back(row.time_s);
  };
  EXPECT_TRUE(read_recording_blocks(path, 5, use).ok());
  EXPECT_TRUE(std::ranges::equal(times_s, recording->rows, {}, {}, &RecordingRow::time_s));
  return recording ? *recording : Recording{};
}

void expect_good_rows(const Recording& recording) {
  ASSERT_EQ(recording.rows.size(), 12u);
  EXPECT_EQ(recording.rows[11].time_s, 0.011);
  EXPECT_EQ(recording.rows[11].position_m, 0.001);
  EXPECT_EQ(recording.rows[11].force_N, 0.5);
}

TEST(Recording, NamesThePlaceOfAFaultAndSaysWhatToDo) {
  const TemporaryFolder folder;
  for (const auto& broken : test::broken_recordings()) {
    SCOPED_TRACE(broken.name);
    const std::string path = folder.with_file("rec.csv", broken.text);
    const auto recording = read_recording(path);
    ASSERT_FALSE(recording.ok());
    const std::string& message = recording.error().message;
    EXPECT_EQ(read_recording_blocks(path, 5, [](const Recording&) {}).error().message, message);
    EXPECT_TRUE(test::has_parts(message, {path + ":" + broken.place + ": found ", ", expected ", "; "}));
    EXPECT_TRUE(test::has_parts(message, broken.parts));
    EXPECT_EQ(utf8_bytes(message), message.size());
  }
}

TEST(Recording, ReadsRowsAndItsNameFromTheFile) {
  const TemporaryFolder folder;
  const Result recording = test::must(read_recording(folder.with_file("skin.a.csv", test::good_recording())));
  EXPECT_EQ(recording->name, "skin.a");
  EXPECT_FALSE(recording->columns.velocity);
  EXPECT_FALSE(recording->columns.acceleration);
  expect_good_rows(*recording);
}

TEST(Recording, AcceptsByteOrderMarkCrlfAndAMissingLastNewline) {
  expect_good_rows(accepted("\xEF\xBB\xBF" + test::good_recording()));
  expect_good_rows(accepted("time_s,position_m,force_N\r\n" + test::good_rows(12, 0, "\r\n")));
  std::string cut = test::good_recording();
  cut.pop_back();
  expect_good_rows(accepted(cut));
  expect_good_rows(accepted(cut + "\r"));
}

TEST(Recording, AcceptsCommentsBeforeTheHeaderAndBlankLinesAtTheEnd) {
  expect_good_rows(accepted("# a rig\n#\n# time_s,position_m\n" + test::good_recording()));
  expect_good_rows(accepted(test::good_recording() + "\n \t\r\n\n"));
}

TEST(Recording, AcceptsColumnsInAnyOrderAndIgnoresFurtherOnes) {
  std::string text = "note,acceleration_m_per_s2,force_N,\xC2\xB5,velocity_m_per_s,time_s,position_m,\n";
  for (int i = 0; i < 10; ++i) {
    text += "#\"x;nan,-3,2,,4,1." + std::to_string(i) + ",-0.25,\xFF\n";
  }
  const Recording recording = accepted(text);
  ASSERT_EQ(recording.rows.size(), 10u);
  EXPECT_TRUE(recording.columns.velocity);
  EXPECT_TRUE(recording.columns.acceleration);
  const RecordingRow& row = recording.rows[3];
  EXPECT_EQ(row.time_s, 1.3);
  EXPECT_EQ(row.position_m, -0.25);
  EXPECT_EQ(row.force_N, 2.0);
  EXPECT_EQ(row.velocity_m_per_s, 4.0);
  EXPECT_EQ(row.acceleration_m_per_s2, -3.0);
}

// A German locale, if the machine has one, while the object lives.
class GermanNumbers {
 public:
  GermanNumbers() : before_(std::setlocale(LC_ALL, nullptr)) {
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "de_DE"}) {
      if (std::setlocale(LC_ALL, name) != nullptr) active_ = true;
    }
  }
  ~GermanNumbers() { std::setlocale(LC_ALL, before_.c_str()); }
  bool active() const { return active_; }

 private:
  std::string before_;
  bool active_ = false;
};

TEST(Recording, ReadsDecimalPointsWhateverTheLocale) {
  const GermanNumbers german;
  if (!german.active()) GTEST_SKIP() << "no German locale on this machine";
  expect_good_rows(accepted(test::good_recording()));
}

// The final verdict of the rules on `count` rows, `step_s` apart, with a gap of a minute after the fourth.
std::optional<RowFault> verdict(int count, double step_s) {
  RowRules rules;
  for (int i = 0; i < count; ++i) {
    if (auto fault = rules.check({i * step_s + (i > 3 ? 60.0 : 0.0), 0.0, 0.0, 0.0, 0.0})) return fault;
  }
  return rules.finish();
}

TEST(RowRules, AllowFivePercentBeyondTheRangeOfRates) {
  for (const int count : {10, 999, 1000, 1001}) {
    EXPECT_FALSE(verdict(count, 0.104).has_value()) << count;
    EXPECT_TRUE(verdict(count, 0.106).has_value()) << count;
    EXPECT_FALSE(verdict(count, 48e-6).has_value()) << count;
    EXPECT_TRUE(verdict(count, 47e-6).has_value()) << count;
  }
}

// Rows at 1 kHz whose values use all 53 bits.
Recording random_recording(std::size_t rows, RecordingColumns columns) {
  std::mt19937_64 random(20090319);
  std::uniform_real_distribution<double> jitter(0.0005, 0.0015);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Recording recording{"rec", columns, {}};
  double time_s = 0.0;
  for (std::size_t i = 0; i < rows; ++i) {
    time_s += jitter(random);
    recording.rows.push_back({time_s, 0.02 * unit(random), 6.0 * unit(random), columns.velocity ? unit(random) : 0.0,
                              columns.acceleration ? 40.0 * unit(random) : 0.0});
  }
  return recording;
}

void expect_same_bits(const Recording& a, const Recording& b) {
  ASSERT_EQ(a.rows.size(), b.rows.size());
  EXPECT_EQ(a.columns.velocity, b.columns.velocity);
  EXPECT_EQ(a.columns.acceleration, b.columns.acceleration);
  for (std::size_t i = 0; i < a.rows.size(); ++i)
    ASSERT_EQ(std::memcmp(&a.rows[i], &b.rows[i], sizeof(RecordingRow)), 0) << "row " << i;
}

void expect_round_trip(const Recording& recording) {
  const TemporaryFolder folder;
  const std::string path = folder.file("rec.csv");
  const Status written = write_recording(path, recording, {"a rig", "two\nlines"}, false);
  ASSERT_TRUE(written.ok()) << written.error().message;
  const Result read = test::must(read_recording(path));
  EXPECT_EQ(read->name, "rec");
  expect_same_bits(*read, recording);
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"rec.csv"});
}

std::string message_for(const Recording& recording) {
  const TemporaryFolder folder;
  const Status written = write_recording(folder.file("rec.csv"), recording, {}, false);
  EXPECT_TRUE(folder.entries().empty());
  return written ? "written" : written.error().message.substr(folder.path().size() + 1);
}

TEST(WriteRecording, ReadsBackTheSameBitsWithEverySetOfColumns) {
  for (const bool velocity : {false, true}) {
    for (const bool acceleration : {false, true}) {
      expect_round_trip(random_recording(20000, {velocity, acceleration}));
    }
  }
}

TEST(WriteRecording, WritesPlainTextWithCommentsFirst) {
  Recording recording{"rec", {true, false}, {}};
  for (int i = 0; i < 10; ++i) recording.rows.push_back({i * 0.5e-3, 0.25, -1.5, 2.0, 9.0});
  const TemporaryFolder folder;
  const std::string path = folder.file("rec.csv");
  ASSERT_TRUE(write_recording(path, recording, {"seed 1", "a\r\tb"}, false).ok());
  const std::string text = test::read_text(path);
  EXPECT_TRUE(
      text.starts_with("# seed 1\n# a  b\ntime_s,position_m,force_N,velocity_m_per_s\n"
                       "0,0.25,-1.5,2\n5e-04,0.25,-1.5,2\n"))
      << text;
  EXPECT_TRUE(text.ends_with("\n"));
}

TEST(WriteRecording, RefusesWhatTheReaderWouldRefuse) {
  const Recording good = random_recording(12, {});
  Recording bad = good;
  bad.rows[4].force_N = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(test::has_parts(message_for(bad), {"rec.csv", "row 5", "force_N nan", "finite", "; "}));
  bad = good;
  bad.rows[4].time_s = bad.rows[3].time_s = 0.25;
  EXPECT_TRUE(test::has_parts(message_for(bad), {"rec.csv", "row 5", "time_s 0.25", "0.25", "time_s"}));
  bad = good;
  bad.rows.resize(9);
  EXPECT_TRUE(test::has_parts(message_for(bad), {"rec.csv", "9 rows", "10", "; "}));
}

TEST(RecordingWriter, GivesTheSameFileRowByRowAndLeavesOutWhatIsRefused) {
  const TemporaryFolder folder;
  const Recording recording = random_recording(5000, {true, false});
  ASSERT_TRUE(write_recording(folder.file("whole.csv"), recording, {"a comment"}, false).ok());
  Result writer = test::must(RecordingWriter::create(folder.file("rows.csv"), recording.columns, {"a comment"}, false));
  for (const RecordingRow& row : recording.rows) {
    ASSERT_TRUE(writer->add(row));
    ASSERT_FALSE(writer->add(row)) << "the same time again";
  }
  RecordingRow far = recording.rows.back();
  far.time_s += 1.0;
  far.position_m = 2.0;
  EXPECT_FALSE(writer->add(far));
  EXPECT_EQ(writer->rows(), 5000u);
  ASSERT_TRUE(writer->commit().ok());
  EXPECT_EQ(test::read_text(folder.file("rows.csv")), test::read_text(folder.file("whole.csv")));
}

Result<RecordingWriter> writer_in_part(const test::TemporaryFolder& folder, bool overwrite) {
  return RecordingWriter::create(folder.file("a.csv"), {}, {"first"}, overwrite, true);
}

TEST(RecordingWriter, ANameThatIsBeingWrittenIsRefusedAtTheStart) {
  const test::TemporaryFolder folder;
  {
    const Result first = test::must(writer_in_part(folder, false));
    for (const bool overwrite : {false, true}) {
      EXPECT_EQ(
          writer_in_part(folder, overwrite).error().message,
          folder.file("a.csv.part") + ": another program is writing it; choose another name, or end that program");
    }
  }
  EXPECT_TRUE(writer_in_part(folder, false).ok()) << "the first one was given up";
}

// As after a kill: the rows of the part are whole, and only --force replaces them.
TEST(RecordingWriter, ThePartOfAKilledProgramIsKept) {
  const test::TemporaryFolder folder;
  const std::string part = folder.file("a.csv.part");
  {
    auto writer = test::must(writer_in_part(folder, false));
    for (int i = 0; i < 2000; ++i) ASSERT_TRUE(writer.add({1e-3 * i, 0.0, 0.0, 0.0, 0.0}));
    ASSERT_TRUE(writer.flush());
    EXPECT_EQ(writer.flushed_rows(), 2000u);
    std::filesystem::copy(part, folder.file("killed"));
  }
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"killed"});
  std::filesystem::rename(folder.file("killed"), part);
  EXPECT_EQ(test::must(read_recording(part)).rows.size(), 2000u);
  EXPECT_EQ(writer_in_part(folder, false).error().message,
            part + " is left from a program that was killed; rename it to keep it, or delete it");
  EXPECT_TRUE(writer_in_part(folder, true).ok());
}

}  // namespace
}  // namespace palpate
