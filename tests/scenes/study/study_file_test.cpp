#include "scenes/study/study_file.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "scenes/study/study_session.h"
#include "tests/support/study_driving.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::read_text;
using test::TemporaryFolder;

const StudyHeader kHeader{"S01"};

StudyRecord example() {
  StudyRecord record;
  record.training = true;
  record.trial = {0.3, 0.18, true};
  record.first_rendered_N = 0.18;
  record.second_rendered_N = 0.2999;
  record.answered_second = true;
  record.response_ms = 731;
  return record;
}

std::unique_ptr<StudyFile> opened(const std::string& path) {
  auto file = StudyFile::open(path, kHeader);
  EXPECT_TRUE(file.ok()) << file.error().message;
  return file.ok() ? std::move(*file) : nullptr;
}

TEST(StudyFile, WritesNothingBeforeTheConsentThenRowByRow) {
  const TemporaryFolder folder;
  const std::string path = folder.file("S01.csv");
  const auto file = opened(path);
  EXPECT_EQ(file->append(example()).error().message, "cannot write " + path + ": there is no consent yet");
  EXPECT_TRUE(folder.entries().empty());
  ASSERT_TRUE(file->consent("Do you agree?", "2024-05-06 10:20").ok());
  ASSERT_TRUE(file->append(example()).ok());
  EXPECT_EQ(read_text(path),
            "# palpate-study 1\n# subject S01\n# procedure constant\n"
            "# timing_ms lead_in 400 ramp 100 hold 900 pause 500\n"
            "# consent accepted, text bf1f2dac, 2024-05-06 10:20\n"
            "part,trial,reference_N,comparison_N,comparison_first,first_rendered_N,second_rendered_N,limited,"
            "answer,response_ms,device,rendered\n"
            "training,1,0.3,0.18,1,0.18,0.2999,0,second,731,unknown,true\n");
}

TEST(StudyFile, IsTakenUpWhereItEnded) {
  const TemporaryFolder folder;
  const std::string path = folder.file("S01.csv");
  {
    const auto file = opened(path);
    ASSERT_TRUE(file->consent("", "").ok());
    ASSERT_TRUE(file->append(example()).ok());
  }
  const std::string whole = read_text(path);
  // Cut in the middle of the next row, as by a power cut.
  folder.with_file("S01.csv", whole + "training,2,0.5,0.3");
  const auto file = opened(path);
  EXPECT_TRUE(file->consented());
  EXPECT_EQ(file->records(), std::vector<StudyRecord>{example()});
  EXPECT_EQ(read_text(path), whole);
  ASSERT_TRUE(file->append(example()).ok());
  EXPECT_EQ(read_text(path), whole + study_row(example(), kHeader));
}

TEST(StudyFile, ASecondSessionIsRefused) {
  const TemporaryFolder folder;
  const std::string path = folder.file("S01.csv");
  auto first = opened(path);
  const auto waiting = opened(path);  // neither has consent yet
  ASSERT_TRUE(first->consent("", "").ok());
  EXPECT_EQ(waiting->consent("", "").error().message,
            path + " was made by another session meanwhile; start again to take it up");
  const auto second = StudyFile::open(path, kHeader);
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().message,
            path + " is in use by another session; end that one first, or take another subject code");
  first.reset();
  EXPECT_TRUE(StudyFile::open(path, kHeader).ok());
}

TEST(StudyFile, OtherStudiesAndOtherFilesAreRefusedAndKept) {
  const TemporaryFolder folder;
  const std::string path = folder.file("S01.csv");
  ASSERT_TRUE(opened(path)->consent("", "").ok());
  const auto other = StudyFile::open(path, {"S02"});
  ASSERT_FALSE(other.ok());
  EXPECT_EQ(other.error().message,
            path +
                ": found a study of subject S01, procedure constant, expected subject S02, procedure constant; "
                "take another folder or subject code");
  const std::string notes = folder.with_file("notes.csv", "time_s,position_m\n");
  EXPECT_EQ(
      StudyFile::open(notes, kHeader).error().message,
      notes + ":1:1: found \"time_s,position_m\", expected the first line of a study file, \"# palpate-study 1\"");
  EXPECT_EQ(read_text(notes), "time_s,position_m\n");
  const auto missing = opened(folder.file("none/S01.csv"));
  EXPECT_EQ(missing->consent("", "").error().message, "cannot write " + folder.file("none/S01.csv") + ": the folder " +
                                                          folder.file("none") + " does not exist; create it first");
}

// A full disk, as the file size limit of a child process.
TEST(StudyFile, AFullDiskLosesNothingThatWasAnswered) {
  const TemporaryFolder folder;
  const std::string path = folder.file("S01.csv");
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    auto file = StudyFile::open(path, kHeader);
    if (!file.ok() || !(*file)->consent("", "").ok() || !(*file)->append(example()).ok()) _exit(1);
    const auto size = static_cast<rlim_t>(std::filesystem::file_size(path));
    const rlimit full{size + 20, RLIM_INFINITY};  // room for half a row
    setrlimit(RLIMIT_FSIZE, &full);
    const Status refused = (*file)->append(example());
    if (refused.ok() || refused.error().message != "cannot write " + path + ": File too large") _exit(2);
    if (std::filesystem::file_size(path) != size || (*file)->records().size() != 1) _exit(3);
    const rlimit free{RLIM_INFINITY, RLIM_INFINITY};
    setrlimit(RLIMIT_FSIZE, &free);
    _exit((*file)->append(example()).ok() ? 0 : 4);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(read_study(path)->records.size(), 2u);
}

// Killed without warning between two trials.
TEST(StudyFile, AKilledSessionIsResumed) {
  const TemporaryFolder folder;
  const std::string path = folder.file("S01.csv");
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    auto file = StudyFile::open(path, kHeader);
    if (!file.ok()) _exit(1);
    auto session = StudySession::create(kHeader, std::move(*file), 0);
    if (!session.ok()) _exit(1);
    (*session)->accept_consent("");
    test::answer_trials(**session, 20, test::truly_larger);
    raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  auto file = StudyFile::open(path, kHeader);
  ASSERT_TRUE(file.ok()) << file.error().message;
  auto session = StudySession::create(kHeader, std::move(*file), 0);
  ASSERT_TRUE(session.ok()) << session.error().message;
  EXPECT_EQ((*session)->view().answered, 12u);
  test::answer_trials(**session, 1, test::truly_larger);
  EXPECT_EQ(read_study(path)->records.back().number, 13u);
}

TEST(StudyFile, StrokesAreNamedAndTakenUpWhereTheyEnded) {
  const TemporaryFolder folder;
  const std::string path = folder.file("S01.csv");
  const StudyHeader header = test::discrimination_header(0.8);
  std::vector<StudyRecord> answered;
  {
    auto file = StudyFile::open(path, header);
    ASSERT_TRUE(file.ok()) << file.error().message;
    auto session = StudySession::create(header, std::move(*file), 0);
    ASSERT_TRUE(session.ok()) << session.error().message;
    (*session)->accept_consent("");
    test::answer_trials(**session, 11, test::truly_like);
    answered = (*session)->store().records();
  }
  const std::string whole = read_text(path);
  EXPECT_EQ(whole.substr(0, whole.find("{")),
            "# palpate-study 1\n# subject S01\n# procedure discriminate\n"
            "# timing_ms lead_in 400 ramp 100 hold 900 pause 500\n# strokes ");
  EXPECT_NE(whole.find("\"from_s\":12.3,"), std::string::npos);
  folder.with_file("S01.csv", whole + "study,8,1.69");  // a power cut
  auto file = StudyFile::open(path, header);
  ASSERT_TRUE(file.ok()) << file.error().message;
  EXPECT_EQ((*file)->records(), answered);
  auto session = StudySession::create(header, std::move(*file), 0);
  ASSERT_TRUE(session.ok()) << session.error().message;
  EXPECT_EQ((*session)->view().answered, 7u);
  test::answer_trials(**session, 1000, test::truly_like);
  session->reset();
  const auto data = read_study(path);
  ASSERT_TRUE(data.ok()) << data.error().message;
  EXPECT_EQ(data->records.size(), 4 + kDiscriminationTrials);
  EXPECT_TRUE(same_strokes(*data->header.strokes, *header.strokes));
  EXPECT_EQ(data->header.strokes->max_over_jnd, header.strokes->max_over_jnd);
}

TEST(StudyFile, OtherStrokesAreRefused) {
  const TemporaryFolder folder;
  const std::string path = folder.file("S01.csv");
  {
    auto file = StudyFile::open(path, test::discrimination_header(0.8));
    ASSERT_TRUE(file.ok() && (*file)->consent("", "").ok());
  }
  const auto other = StudyFile::open(path, test::discrimination_header(0.9));
  ASSERT_FALSE(other.ok());
  EXPECT_EQ(other.error().message,
            path +
                ": found strokes of \"recorded force\" and \"greedy-100\" in silicone 2, expected those of this "
                "session, \"recorded force\" and \"greedy-100\" in silicone 2, with the same forces; take another "
                "folder or subject code");
}

}  // namespace
}  // namespace palpate
