#include "scenes/study/study_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "tests/support/replaced.h"
#include "tests/support/study_driving.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::read_text;

const StudyHeader kHeader{"S01"};
constexpr const char* kRow = "training,1,0.3,0.18,1,0.18,0.2999,0,second,731,unknown,true\n";

StudyRecord example() {
  StudyRecord record{{0.3, 0.18, true, true}};
  record.first_rendered_N = 0.18;
  record.second_rendered_N = 0.2999;
  record.answered_second = true;
  record.response_ms = 731;
  return record;
}

class StudyFileTest : public ::testing::Test {
 protected:
  std::unique_ptr<StudyFile> opened(const std::string& path) {
    auto file = StudyFile::open(path, kHeader);
    EXPECT_TRUE(file.ok()) << file.error().message;
    return file.ok() ? std::move(*file) : nullptr;
  }
  std::string complaint(const std::string& path, const StudyHeader& header = kHeader) {
    const auto file = StudyFile::open(path, header);
    return file.ok() ? "accepted" : file.error().message;
  }

  const test::TemporaryFolder folder_;
  const std::string path_ = folder_.file("S01.csv");
};

TEST_F(StudyFileTest, WritesNothingBeforeTheConsentThenRowByRow) {
  const auto file = opened(path_);
  EXPECT_FALSE(file->append(example()).ok());
  EXPECT_TRUE(folder_.entries().empty());
  ASSERT_TRUE(file->consent("2024-05-06 10:20").ok());
  ASSERT_TRUE(file->append(example()).ok());
  EXPECT_EQ(read_text(path_),
            "# palpate-study 1\n# subject S01\n# procedure constant\n"
            "# timing_ms lead_in 400 ramp 100 hold 900 pause 500\n# consent accepted, 2024-05-06 10:20\n"
            "part,trial,reference_N,comparison_N,comparison_first,first_rendered_N,second_rendered_N,limited,"
            "answer,response_ms,device,rendered\n" +
                std::string(kRow));
}

TEST_F(StudyFileTest, IsResumedAfterTheLastCompleteRow) {
  {
    const auto file = opened(path_);
    ASSERT_TRUE(file->consent("").ok());
    ASSERT_TRUE(file->append(example()).ok());
  }
  const std::string whole = read_text(path_);
  // The next row is truncated, as by a power failure.
  folder_.with_file("S01.csv", whole + "training,2,0.5,0.3");
  const auto file = opened(path_);
  EXPECT_TRUE(file->consented());
  EXPECT_EQ(file->records(), std::vector<StudyRecord>{example()});
  EXPECT_EQ(read_text(path_), whole);
  ASSERT_TRUE(file->append(example()).ok());
  EXPECT_EQ(read_text(path_), whole + kRow);
}

TEST_F(StudyFileTest, ASecondSessionIsRefused) {
  auto first = opened(path_);
  const auto waiting = opened(path_);  // both have no consent yet
  ASSERT_TRUE(first->consent("").ok());
  EXPECT_NE(waiting->consent("").error().message.find("start again to resume it"), std::string::npos);
  EXPECT_NE(complaint(path_).find(path_ + " is in use by another session"), std::string::npos) << complaint(path_);
  first.reset();
  EXPECT_EQ(complaint(path_), "accepted");
}

TEST_F(StudyFileTest, OtherStudiesAndOtherFilesAreRefusedAndKept) {
  ASSERT_TRUE(opened(path_)->consent("").ok());
  const std::string other = complaint(path_, {"S02"});
  EXPECT_NE(other.find("subject S01, constant stimuli, expected subject S02, constant stimuli"), std::string::npos)
      << other;
  EXPECT_NE(complaint(path_, test::discrimination_header(0.8)).find("expected subject S01, strokes of"),
            std::string::npos);
  const std::string notes = folder_.with_file("notes.csv", "time_s,position_m\n");
  EXPECT_EQ(complaint(notes).rfind(notes + ":1:1: found \"time_s,position_m\"", 0), 0u) << complaint(notes);
  EXPECT_EQ(read_text(notes), "time_s,position_m\n");
}

TEST_F(StudyFileTest, AFullDiskLosesNothingThatWasAnswered) {
  const auto file = opened(path_);
  ASSERT_TRUE(file->consent("").ok() && file->append(example()).ok());
  const auto size = std::filesystem::file_size(path_);
  {
    const test::FullDisk full(size + 20);  // room for half a row
    const Status refused = file->append(example());
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().message, "cannot write " + path_ + ": File too large");
  }
  EXPECT_EQ(std::filesystem::file_size(path_), size);
  EXPECT_EQ(file->records().size(), 1u);
  EXPECT_TRUE(file->append(example()).ok());
  EXPECT_EQ(read_study(path_)->records.size(), 2u);
}

// The process is killed between two trials.
TEST_F(StudyFileTest, AKilledSessionIsResumed) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    auto session = test::session_at(path_);
    if (!session.ok()) _exit(1);
    (*session)->accept_consent("");
    test::answer_trials(**session, 20, test::truly_larger);
    raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  const auto session = test::session_at(path_);
  ASSERT_TRUE(session.ok()) << session.error().message;
  EXPECT_EQ((*session)->view().answered, 12u);
  test::answer_trials(**session, 1, test::truly_larger);
  EXPECT_EQ(read_study(path_)->records.back().number, 13u);
}

TEST_F(StudyFileTest, StrokesAreNamedAndResumed) {
  const StudyHeader header = test::discrimination_header(0.8);
  std::vector<StudyRecord> answered;
  {
    const auto session = test::session_at(path_, header);
    ASSERT_TRUE(session.ok()) << session.error().message;
    (*session)->accept_consent("");
    test::answer_trials(**session, 11, test::truly_like);
    answered = (*session)->file().records();
  }
  const std::string whole = read_text(path_);
  EXPECT_NE(whole.find("# procedure discriminate\n"), std::string::npos);
  EXPECT_NE(whole.find("\"from_s\":12.3,"), std::string::npos);
  folder_.with_file("S01.csv", whole + "study,8,1.69");  // a power failure
  {
    const auto session = test::session_at(path_, header);
    ASSERT_TRUE(session.ok()) << session.error().message;
    EXPECT_EQ((*session)->file().records(), answered);
    EXPECT_EQ((*session)->view().answered, 7u);
    test::answer_trials(**session, 1000, test::truly_like);
  }
  const auto data = read_study(path_);
  ASSERT_TRUE(data.ok()) << data.error().message;
  EXPECT_EQ(data->records.size(), 4 + kDiscriminationTrials);
  EXPECT_EQ(data->header.strokes->max_over_jnd, header.strokes->max_over_jnd);
  const std::string other = complaint(path_, test::discrimination_header(0.9));
  EXPECT_NE(other.find("with the same forces"), std::string::npos) << other;
}

const std::string kGood = study_header_text(kHeader, "2024-05-06") +
                          "training,1,0.3,0.18,1,0.18,0.3,0,second,731,paddle,true\n"
                          "study,1,2.5,3.5,0,2.4,3.5,1,first,20,mouse,false\n";
const std::string kGoodStrokes = study_header_text(test::discrimination_header(0.8), "2024-05-06") +
                                 "study,1,1.7,1.36,0,1.7,1.36,0,first,20,1.7,0.001,paddle,true\n";

std::string complaint_of(const std::string& text) {
  const auto data = parse_study(text, "S01.csv");
  return data.ok() ? "accepted" : data.error().message;
}

TEST(StudyReader, ReadsEveryField) {
  const auto data = parse_study(kGood, "S01.csv");
  ASSERT_TRUE(data.ok()) << data.error().message;
  EXPECT_EQ(data->header.subject, "S01");
  EXPECT_EQ(data->header.strokes, nullptr);
  ASSERT_EQ(data->records.size(), 2u);
  EXPECT_TRUE(data->records[0].trial.training);
  EXPECT_TRUE(data->records[0].rendered);
  const StudyRecord& record = data->records[1];
  EXPECT_EQ(record.trial, (StudyTrial{2.5, 3.5, false}));
  EXPECT_EQ(record.first_rendered_N, 2.4);
  EXPECT_TRUE(record.limited);
  EXPECT_FALSE(record.rendered);
  EXPECT_EQ(record.device, "mouse");
  EXPECT_FALSE(record.comparison_judged_larger());
  EXPECT_FALSE(record.found_larger());
  EXPECT_DOUBLE_EQ(record.rendered_difference(), 1.1 / 2.4);
  EXPECT_EQ(kGood.find(study_row(record, data->header)), kGood.rfind("study,1"));
  const auto strokes = parse_study(kGoodStrokes, "S01.csv");
  ASSERT_TRUE(strokes.ok()) << strokes.error().message;
  EXPECT_EQ(strokes->records.front().worst_N, 0.001);
  EXPECT_EQ(strokes->header.strokes->recording, "silicone 2");
  EXPECT_EQ(kGoodStrokes.find(study_row(strokes->records.front(), strokes->header)), kGoodStrokes.rfind("study,1"));
}

TEST(StudyReader, RefusesWithPlaceFoundAndExpected) {
  const auto expect = [](const std::string& text, const std::string& place, const std::string& found,
                         const std::string& expected) {
    const std::string message = complaint_of(text);
    EXPECT_EQ(message.rfind("S01.csv:" + place + ": found \"" + found, 0), 0u) << message;
    EXPECT_NE(message.find("\", expected " + expected), std::string::npos) << message;
  };
  const auto changed = [](const char* from, const char* to) { return test::replaced(kGood, from, to); };
  expect(changed("study 1", "study 2"), "1:1", "# palpate-study 2", "the first line");
  expect(changed("S01", "Anna"), "2:1", "# subject Anna", "\"# subject \" and a code");
  expect(changed("constant", "other"), "3:1", "# procedure other", "\"# procedure \"");
  expect(changed("ramp 100", "ramp 60"), "4:1", "# timing_ms", "\"# timing_ms");
  expect(changed("accepted", "refused"), "5:1", "# consent refused", "\"# consent accepted");
  expect(changed(",response_ms", ""), "6:1", "part,trial", "the columns part,trial");
  expect(changed("training,1", "practice,1"), "7:1", "practice", "training or study");
  expect(changed("study,1,", "study,0,"), "8:7", "0", "a whole number above 0");
  expect(changed("3.5,0", "nan,0"), "8:13", "nan", "a force above 0 and up to 10 N");
  expect(changed(",2.4,", ",-2.4,"), "8:19", "-2.4", "a force from 0 to 10 N");
  expect(changed("first,20", "both,20"), "8:29", "both", "first or second");
  expect(changed("first,20", "first,-1"), "8:35", "-1", "a whole number of ms");
  expect(changed(",first,20", ",first"), "8:1", "study,1,2.5", "a row of 12 fields");
  expect(changed("first,20", "first,20,1"), "8:1", "study,1,2.5", "a row of 12 fields");
  const auto strokes = [](const char* from, const char* to) { return test::replaced(kGoodStrokes, from, to); };
  expect(strokes("# strokes ", "# "), "5:1", "# {\"checksum", "\"# strokes \"");
  expect(strokes(",1.7,0.001,paddle,true", ""), "8:1", "study,1,1.7", "a row of 14 fields");
  expect(strokes(",0.001,", ",-1,"), "8:44", "-1", "a force from 0 to 10 N");
  for (const char* broken : {"{", "\"checksum\"", "\"offset_N\"", "\"silicone 2\"", "12.3,"})
    EXPECT_NE(complaint_of(strokes(broken, "?")), "accepted") << broken;
  EXPECT_EQ(read_study("/none/S01.csv").error().message.rfind("/none/S01.csv: found no such file", 0), 0u);
}

TEST(StudyReader, EveryTruncationIsReadOrRefused) {
  for (const std::string& good : {kGood, kGoodStrokes}) {
    for (std::size_t length = 0; length < good.size(); ++length) {
      const auto data = parse_study(good.substr(0, length), "S01.csv");
      EXPECT_TRUE(!data.ok() || data->whole_bytes <= length) << length;
    }
  }
}

}  // namespace
}  // namespace palpate
