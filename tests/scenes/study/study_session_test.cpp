#include "scenes/study/study_session.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/full_disk.h"
#include "tests/support/message_parts.h"
#include "tests/support/study_driving.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::answer_trials;
using test::truly_larger;
using test::truly_like;

class StudySessionTest : public ::testing::Test {
 protected:
  // A session of a subject who has given consent.
  std::unique_ptr<StudySession> begun(const StudyHeader& header = {"S01"}, std::uint64_t rest_ticks = 0) {
    auto session = test::must(test::session_at(path_, header, rest_ticks));
    session->accept_consent("today");
    return session;
  }

  const test::TemporaryFolder folder_;
  const std::string path_ = folder_.file("S01.csv");
};

const std::vector<StudyRecord>& records_of(const std::unique_ptr<StudySession>& session) {
  return session->file().records();
}

// The device drops out for 30 ms in the first push.
TEST_F(StudySessionTest, RepeatsATrialInWhichTheDeviceDropsOut) {
  const auto session = begun();
  session->proceed();
  const StudyTrial trial = session->trial();
  double rendered_N = 0.0;
  for (int tick = 0; session->state() == StudyState::presenting; ++tick) {
    rendered_N = session->next_force_N(tick > 800 && tick <= 830 ? 0.0 : rendered_N);
    session->update();
  }
  EXPECT_EQ(session->state(), StudyState::ready);
  session->answer(true);
  EXPECT_TRUE(records_of(session).empty()) << "there is nothing to answer";
  session->proceed();
  test::run_until_asked(*session);
  EXPECT_EQ(session->state(), StudyState::answering);
  EXPECT_EQ(session->trial(), trial);
}

TEST_F(StudySessionTest, NothingIsPresentedBeforeTheConsent) {
  const auto session = test::must(test::session_at(path_));
  EXPECT_EQ(session->state(), StudyState::consent);
  EXPECT_TRUE(test::has_parts(session->view().message, {"Do you agree to take part?"}));
  session->proceed();
  session->answer(true);
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(session->next_force_N(0.0), 0.0);
  EXPECT_EQ(session->state(), StudyState::consent);
}

TEST_F(StudySessionTest, RunsFromConsentToTheEnd) {
  for (const bool strokes : {false, true}) {
    SCOPED_TRACE(strokes);
    std::filesystem::remove(path_);
    const auto session = begun(strokes ? test::discrimination_header(0.8) : StudyHeader{"S01"});
    const auto right = strokes ? truly_like : truly_larger;
    EXPECT_EQ(session->state(), StudyState::ready);
    EXPECT_TRUE(session->view().training);
    EXPECT_TRUE(test::has_parts(session->view().message, {strokes ? "like the reference" : "larger"}));
    answer_trials(*session, 1, [&](const StudyTrial& trial) { return !right(trial); });
    EXPECT_EQ(session->view().was_correct, false);
    const std::size_t study = strokes ? kDiscriminationTrials : 320, all = study + (strokes ? 4 : 8);
    EXPECT_EQ(answer_trials(*session, 1000, right), all - 1);
    EXPECT_EQ(session->state(), StudyState::done);
    EXPECT_EQ(session->view().answered, study);
    ASSERT_EQ(records_of(session).size(), all);
    for (const StudyRecord& record : records_of(session)) {
      EXPECT_EQ(strokes ? record.found_reference() : record.found_larger(), &record != &records_of(session).front());
      EXPECT_EQ(record.first_rendered_N, record.trial.first_N());
      EXPECT_EQ(record.second_rendered_N, record.trial.second_N());
      EXPECT_EQ(record.reminder_rendered_N, strokes ? record.trial.reference_N : 0.0);
      EXPECT_EQ(record.worst_N, 0.0);
      EXPECT_FALSE(record.limited);
    }
    session->proceed();
    EXPECT_EQ(session->state(), StudyState::done);
  }
}

TEST_F(StudySessionTest, AsksAgainForAnAnswerThatCouldNotBeStored) {
  const auto session = begun();
  answer_trials(*session, 3, truly_larger);
  {
    const test::FullDisk full(std::filesystem::file_size(path_) + 20);
    EXPECT_EQ(answer_trials(*session, 1, truly_larger), 0u);
  }
  EXPECT_EQ(session->state(), StudyState::answering);
  EXPECT_TRUE(test::has_parts(session->view().message, {"could not be stored: "}));
  session->answer(true);
  EXPECT_EQ(session->state(), StudyState::presenting);
  EXPECT_EQ(records_of(session).size(), 4u);
}

TEST_F(StudySessionTest, AbortWorksInEveryState) {
  for (std::size_t trials = 0; trials < 12; ++trials) {
    std::filesystem::remove(path_);
    const auto session = begun();
    answer_trials(*session, trials, truly_larger);
    for (int i = 0; i < 600; ++i) session->next_force_N(0.0);
    session->abort();
    EXPECT_EQ(session->state(), StudyState::aborted);
    for (int i = 0; i < 40; ++i) session->next_force_N(0.0);
    for (int i = 0; i < 1000; ++i) ASSERT_EQ(session->next_force_N(0.0), 0.0);
    session->proceed();
    session->answer(true);
    EXPECT_EQ(session->state(), StudyState::aborted);
    EXPECT_EQ(records_of(session).size(), trials);
  }
}

TEST_F(StudySessionTest, ResumesAfterTheLastAnswer) {
  for (const bool strokes : {false, true}) {
    SCOPED_TRACE(strokes);
    const StudyHeader header = strokes ? test::discrimination_header(0.8) : StudyHeader{"S01"};
    const auto right = strokes ? truly_like : truly_larger;
    std::filesystem::remove(path_);
    auto session = begun(header);
    answer_trials(*session, 1000, right);
    const std::string whole = test::read_text(path_);
    for (const std::size_t until : {0u, 5u, 8u, 30u}) {
      session.reset();
      std::filesystem::remove(path_);
      session = begun(header);
      answer_trials(*session, until, right);
      session.reset();
      session = test::must(test::session_at(path_, header));
      EXPECT_EQ(session->state(), StudyState::ready) << "consent is asked once";
      answer_trials(*session, 1000, right);
      EXPECT_EQ(test::read_text(path_), whole);
    }
  }
}

}  // namespace
}  // namespace palpate
