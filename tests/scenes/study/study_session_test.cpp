#include "scenes/study/study_session.h"

#include <gtest/gtest.h>

#include "tests/support/study_driving.h"

namespace palpate {
namespace {

using test::answer_trials;
using test::MemoryStore;
using test::truly_larger;

StudyHeader header() { return {"S01"}; }

std::unique_ptr<StudySession> begun(const StudyHeader& with, std::unique_ptr<StudyStore> store,
                                    std::uint64_t rest = 0) {
  auto session = StudySession::create(with, std::move(store), rest);
  EXPECT_TRUE(session.ok()) << session.error().message;
  (*session)->accept_consent("today");
  return std::move(*session);
}

// 30 ms without force in the first push, most of which is rendered.
TEST(StudySession, ATrialInWhichTheDeviceDropsOutComesAgain) {
  const auto session = begun(header(), std::make_unique<MemoryStore>());
  session->proceed();
  const StudyTrial trial = session->trial();
  double rendered_N = 0.0;
  for (int tick = 0; session->state() == StudyState::presenting; ++tick) {
    rendered_N = session->next_force_N(tick > 800 && tick <= 830 ? 0.0 : rendered_N);
    session->update();
  }
  EXPECT_EQ(session->state(), StudyState::ready);
  session->answer(true);
  EXPECT_TRUE(session->store().records().empty()) << "there is nothing to answer";
  session->proceed();
  test::run_until_asked(*session);
  EXPECT_EQ(session->state(), StudyState::answering);
  EXPECT_EQ(session->trial(), trial);
}

// A disk that refuses while `full`.
class FullStore final : public StudyStore {
 public:
  bool full = false;
  bool consented() const noexcept override { return inner_.consented(); }
  const std::vector<StudyRecord>& records() const noexcept override { return inner_.records(); }
  Status consent(const std::string& text, const std::string& when) override {
    return full ? Status(Error{"no space left"}) : inner_.consent(text, when);
  }
  Status append(const StudyRecord& record) override {
    return full ? Status(Error{"no space left"}) : inner_.append(record);
  }

 private:
  MemoryStore inner_;
};

TEST(StudySession, NothingIsPresentedBeforeTheConsent) {
  auto session = StudySession::create(header(), std::make_unique<MemoryStore>());
  ASSERT_TRUE(session.ok());
  EXPECT_EQ((*session)->state(), StudyState::consent);
  EXPECT_EQ((*session)->view().message, study_consent_text(false));
  (*session)->proceed();
  (*session)->answer(true);
  for (int i = 0; i < 1000; ++i) ASSERT_EQ((*session)->next_force_N(0.0), 0.0);
  EXPECT_EQ((*session)->state(), StudyState::consent);
}

TEST(StudySession, RunsFromConsentToTheEnd) {
  const auto session = begun(header(), std::make_unique<MemoryStore>());
  EXPECT_EQ(session->state(), StudyState::ready);
  EXPECT_TRUE(session->view().training);
  const std::size_t trials = 320;
  EXPECT_EQ(answer_trials(*session, 1000, truly_larger), 8 + trials);
  EXPECT_EQ(session->state(), StudyState::done);
  EXPECT_EQ(session->view().answered, trials);
  const std::vector<StudyRecord>& records = session->store().records();
  ASSERT_EQ(records.size(), 8 + trials);
  for (const StudyRecord& record : records) {
    EXPECT_TRUE(record.found_larger());
    EXPECT_EQ(record.first_rendered_N, record.trial.first_N());
    EXPECT_EQ(record.second_rendered_N, record.trial.second_N());
    EXPECT_FALSE(record.limited);
  }
  session->proceed();
  EXPECT_EQ(session->state(), StudyState::done);
}

TEST(StudySession, TheTrainingTellsRightFromWrong) {
  const auto session = begun(header(), std::make_unique<MemoryStore>());
  EXPECT_FALSE(session->view().has_feedback);
  answer_trials(*session, 1, truly_larger);
  EXPECT_TRUE(session->view().has_feedback);
  EXPECT_TRUE(session->view().was_correct);
  answer_trials(*session, 1, [](const StudyTrial& trial) { return !truly_larger(trial); });
  EXPECT_FALSE(session->view().was_correct);
  answer_trials(*session, 6, truly_larger);
  EXPECT_EQ(session->state(), StudyState::ready);
  EXPECT_FALSE(session->view().training);
  answer_trials(*session, 1, truly_larger);
  EXPECT_FALSE(session->view().has_feedback) << "the study itself tells nothing";
}

TEST(StudySession, ShowsWhichForceIsPresentedAndCountsTheResponse) {
  const auto session = begun(header(), std::make_unique<MemoryStore>());
  session->proceed();
  std::vector<int> intervals;
  double rendered_N = 0.0;
  for (int i = 0; session->state() == StudyState::presenting && i < 10000; ++i) {
    rendered_N = session->next_force_N(rendered_N);
    session->update();
    if (intervals.empty() || session->view().interval != intervals.back())
      intervals.push_back(session->view().interval);
  }
  EXPECT_EQ(intervals, (std::vector<int>{0, 1, 0, 2, 0}));
  for (int i = 0; i < 730; ++i) session->next_force_N(0.0);
  session->answer(true);
  EXPECT_EQ(session->store().records().front().response_ms, 731u);
}

TEST(StudySession, BreaksLastTheirTime) {
  const auto session = begun(header(), std::make_unique<MemoryStore>(), 500);
  answer_trials(*session, 8 + 64, truly_larger);
  ASSERT_EQ(session->state(), StudyState::rest);
  EXPECT_EQ(session->view().rest_ticks_left, 500u);
  for (int i = 0; i < 499; ++i) session->next_force_N(0.0);
  session->proceed();
  EXPECT_EQ(session->state(), StudyState::rest);
  session->next_force_N(0.0);
  session->proceed();
  EXPECT_EQ(session->state(), StudyState::presenting);
}

TEST(StudySession, AnAnswerThatIsNotStoredIsKeptUntilItIs) {
  auto store = std::make_unique<FullStore>();
  FullStore& disk = *store;
  const auto session = begun(header(), std::move(store));
  answer_trials(*session, 3, truly_larger);
  disk.full = true;
  EXPECT_EQ(answer_trials(*session, 1, truly_larger), 0u);
  EXPECT_EQ(session->state(), StudyState::unsaved);
  EXPECT_EQ(session->view().message, "Your answer could not be stored: no space left. Call the experimenter.");
  session->retry();
  EXPECT_EQ(session->state(), StudyState::unsaved);
  disk.full = false;
  session->retry();
  EXPECT_EQ(session->state(), StudyState::presenting);
  EXPECT_EQ(session->store().records().size(), 4u);
  disk.full = true;
  answer_trials(*session, 1, truly_larger);
  disk.full = false;
  session->abort();
  EXPECT_EQ(session->state(), StudyState::aborted);
  EXPECT_EQ(session->store().records().size(), 5u) << "the abort tries once more";
}

TEST(StudySession, ConsentThatIsNotStoredIsNone) {
  auto store = std::make_unique<FullStore>();
  store->full = true;
  auto session = StudySession::create(header(), std::move(store));
  ASSERT_TRUE(session.ok());
  (*session)->accept_consent("");
  EXPECT_EQ((*session)->state(), StudyState::consent);
  EXPECT_EQ((*session)->view().message, "no space left");
}

TEST(StudySession, AbortWorksInEveryState) {
  for (int trials = 0; trials < 12; ++trials) {
    const auto session = begun(header(), std::make_unique<MemoryStore>());
    answer_trials(*session, static_cast<std::size_t>(trials), truly_larger);
    for (int i = 0; i < 600; ++i) session->next_force_N(0.0);
    session->abort();
    EXPECT_EQ(session->state(), StudyState::aborted);
    for (int i = 0; i < 40; ++i) session->next_force_N(0.0);
    for (int i = 0; i < 1000; ++i) ASSERT_EQ(session->next_force_N(0.0), 0.0);
    session->proceed();
    session->answer(true);
    EXPECT_EQ(session->state(), StudyState::aborted);
    EXPECT_EQ(session->store().records().size(), static_cast<std::size_t>(trials));
  }
}

TEST(StudySession, GoesOnWhereAnEarlierOneEnded) {
  const auto whole = begun(header(), std::make_unique<MemoryStore>());
  answer_trials(*whole, 1000, truly_larger);
  for (const std::size_t until : {0u, 5u, 8u, 30u}) {
    const auto first = begun(header(), std::make_unique<MemoryStore>());
    answer_trials(*first, until, truly_larger);
    auto store = std::make_unique<MemoryStore>();
    ASSERT_TRUE(store->consent("", "").ok());
    for (const StudyRecord& record : first->store().records()) ASSERT_TRUE(store->append(record).ok());
    auto second = StudySession::create(header(), std::move(store), 0);
    ASSERT_TRUE(second.ok()) << second.error().message;
    EXPECT_EQ((*second)->state(), StudyState::ready) << "consent is asked once";
    answer_trials(**second, 1000, truly_larger);
    EXPECT_EQ((*second)->store().records(), whole->store().records());
  }
}

TEST(StudySession, RefusesAnswersThatThePlanDidNotAskFor) {
  auto store = std::make_unique<MemoryStore>();
  StudyRecord record;
  record.training = true;
  record.trial = {0.3, 0.2, false};
  ASSERT_TRUE(store->append(record).ok());
  const auto session = StudySession::create(header(), std::move(store));
  ASSERT_FALSE(session.ok());
  EXPECT_EQ(session.error().message,
            "the stored training answer 1 is to a trial that this subject's plan does not have there; was the "
            "file made by another version, or changed? Start a new file");
}

TEST(StudySession, RefusesNames) { EXPECT_FALSE(StudySession::create({"Anna"}, std::make_unique<MemoryStore>()).ok()); }

TEST(StudySession, StrokesGoFromConsentToTheEnd) {
  const StudyHeader with = test::discrimination_header(0.8);
  auto session = StudySession::create(with, std::make_unique<MemoryStore>(), 0);
  ASSERT_TRUE(session.ok()) << session.error().message;
  EXPECT_NE((*session)->view().message.find("which of the last two was like the first"), std::string::npos);
  (*session)->accept_consent("today");
  EXPECT_EQ(answer_trials(**session, 1000, test::truly_like), 4 + kDiscriminationTrials);
  EXPECT_EQ((*session)->state(), StudyState::done);
  for (const StudyRecord& record : (*session)->store().records()) {
    EXPECT_TRUE(record.found_reference());
    EXPECT_EQ(record.first_rendered_N, record.trial.first_N());
    EXPECT_EQ(record.second_rendered_N, record.trial.second_N());
    EXPECT_EQ(record.reminder_rendered_N, record.trial.reference_N);
    EXPECT_EQ(record.worst_N, 0.0);
  }
}

TEST(StudySession, ShowsTheReferenceBeforeTheTwoAndTellsRightFromWrongInTheTraining) {
  const auto session = begun(test::discrimination_header(0.8), std::make_unique<MemoryStore>());
  session->proceed();
  std::vector<int> shown;
  double rendered_N = 0.0;
  for (int i = 0; session->state() == StudyState::presenting && i < 10000; ++i) {
    rendered_N = session->next_force_N(rendered_N);
    session->update();
    const int now = session->view().reminder ? 9 : session->view().interval;
    if (shown.empty() || now != shown.back()) shown.push_back(now);
  }
  EXPECT_EQ(shown, (std::vector<int>{0, 9, 0, 1, 0, 2, 0}));
  session->answer(!test::truly_like(session->trial()));
  EXPECT_TRUE(session->view().has_feedback);
  EXPECT_FALSE(session->view().was_correct);
  answer_trials(*session, 1, test::truly_like);
  EXPECT_TRUE(session->view().was_correct);
  answer_trials(*session, 3, test::truly_like);
  EXPECT_FALSE(session->view().has_feedback) << "none after the training";
}

TEST(StudySession, RefusesStrokesOfAnotherLength) {
  auto longer = std::make_shared<StrokePair>(*test::example_strokes(0.8));
  longer->comparison_N.push_back(1.0);
  EXPECT_EQ(StudySession::create({"S01", longer}, std::make_unique<MemoryStore>()).error().message,
            "found no two strokes of 1100 ms, expected them to be told apart");
}

}  // namespace
}  // namespace palpate
