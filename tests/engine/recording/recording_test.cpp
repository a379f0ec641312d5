#include "engine/recording/recording.h"

#include <gtest/gtest.h>

#include <clocale>

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
  auto recording = read_recording(folder.with_file("rec.csv", text));
  EXPECT_TRUE(recording.ok()) << recording.error().message;
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
    EXPECT_TRUE(test::has_parts(message, {path + ":" + broken.place + ": found ", ", expected ", "; "}));
    EXPECT_TRUE(test::has_parts(message, broken.parts));
    EXPECT_EQ(utf8_bytes(message), message.size());
  }
}

TEST(Recording, ReadsRowsAndItsNameFromTheFile) {
  const TemporaryFolder folder;
  const auto recording = read_recording(folder.with_file("skin.a.csv", test::good_recording()));
  ASSERT_TRUE(recording.ok()) << recording.error().message;
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

TEST(Recording, AcceptsBlanksPlusSignsAndExponents) {
  std::string text = test::good_header();
  for (int i = 0; i < 10; ++i) text += " +" + std::to_string(i) + "e-3\t, -.5 ,\t1.E1 \n";
  const Recording recording = accepted(text);
  ASSERT_EQ(recording.rows.size(), 10u);
  EXPECT_EQ(recording.rows[9].time_s, 0.009);
  EXPECT_EQ(recording.rows[9].position_m, -0.5);
  EXPECT_EQ(recording.rows[9].force_N, 10.0);
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

}  // namespace
}  // namespace palpate
