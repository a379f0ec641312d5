#include "scenes/study/study_session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "tests/support/full_disk.h"
#include "tests/support/message_parts.h"
#include "tests/support/rt_guard.h"
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

Stimuli stimuli(double first_N, double second_N) { return {Stimulus{}, Stimulus{first_N}, Stimulus{second_N}}; }

// The forces of `ticks` ticks. The rendered force is `gain` times each.
std::vector<double> run(StudyPresenter& presenter, std::size_t ticks, double gain = 1.0) {
  std::vector<double> forces;
  double rendered_N = 0.0;
  for (std::size_t i = 0; i < ticks; ++i) {
    const double force_N = presenter.tick(rendered_N);
    forces.push_back(force_N);
    rendered_N = gain * force_N;
  }
  return forces;
}

// Constant forces, and strokes with a reminder.
TEST(StudyPresenter, PresentsTheStimuliExactToTheTick) {
  const auto strokes = test::example_strokes(0.9);
  const Stimulus half{0.5, &strokes->reference_N}, reference{1.0, &strokes->reference_N};
  for (const Stimuli& shown : {stimuli(1.0, 2.5), Stimuli{half, Stimulus{1.0, &strokes->comparison_N}, reference}}) {
    StudyPresenter presenter;
    for (const double force_N : run(presenter, 100)) ASSERT_EQ(force_N, 0.0) << "idle";
    EXPECT_EQ(presenter.present(shown), 1u);
    const std::size_t first = has_reminder(shown) ? 0 : 1, period = kInterval_ticks + kPause_ticks;
    const std::size_t end = kLeadIn_ticks + (3 - first) * period - kPause_ticks;
    const std::vector<double> forces = run(presenter, end + 100);
    for (std::size_t i = 0; i < forces.size(); ++i) {
      double expected_N = 0.0;
      for (std::size_t k = first; k < 3; ++k) {
        const std::size_t at = i - kLeadIn_ticks - (k - first) * period;  // wraps before the interval
        if (at >= kInterval_ticks) continue;
        const std::size_t edge = std::min<std::size_t>(at, kInterval_ticks - 1 - at);
        const double half_cosine = 0.5 - 0.5 * std::cos(std::acos(-1.0) * static_cast<double>(edge) / kRamp_ticks);
        expected_N = (edge >= kRamp_ticks ? 1.0 : half_cosine) * shown[k].size *
                     (has_reminder(shown) ? (*shown[k].stroke_N)[at] : 1.0);
      }
      ASSERT_NEAR(forces[i], expected_N, 1e-12) << i;
    }
    const PresentationState& state = presenter.newest();
    EXPECT_EQ(state.presentation, 1u);
    EXPECT_EQ(state.finished_at, 100u + end);
    EXPECT_EQ(state.tick, 200u + end);
    EXPECT_NEAR(state.rendered_N[0], has_reminder(shown) ? 0.5 * strokes->reference_mean_N : 0.0, 1e-4);
    EXPECT_NEAR(state.rendered_N[1], has_reminder(shown) ? strokes->comparison_mean_N : 1.0, 1e-4);
    EXPECT_NEAR(state.rendered_N[2], has_reminder(shown) ? strokes->reference_mean_N : 2.5, 1e-4);
    EXPECT_NEAR(state.worst_N, 0.0, 1e-12);
    EXPECT_FALSE(state.limited) << "the ramps stay below the limiter's slew";
  }
}

TEST(StudyPresenter, LimitsForcesThatAreTooLarge) {
  const std::vector<double> strong(700, 50.0);  // shorter than an interval
  const Stimulus stroke{1.0, &strong};
  for (const Stimuli& shown : {stimuli(50.0, std::nan("")), Stimuli{stroke, stroke, stroke}}) {
    StudyPresenter presenter;
    presenter.present(shown);
    const std::vector<double> forces = run(presenter, 6000);
    EXPECT_EQ(*std::max_element(forces.begin(), forces.end()), kLargestStudyForce_N);
    for (std::size_t i = 1; i < forces.size(); ++i) ASSERT_LE(std::abs(forces[i] - forces[i - 1]), 0.1 + 1e-9);
    for (std::size_t i = 5000; i < forces.size(); ++i) ASSERT_EQ(forces[i], 0.0);
    EXPECT_TRUE(presenter.newest().limited);
  }
}

TEST(StudyPresenter, StopIsImmediateAndPermanent) {
  StudyPresenter presenter;
  presenter.present(stimuli(3.0, 2.0));
  const std::vector<double> before = run(presenter, kLeadIn_ticks + kRamp_ticks + 10);
  ASSERT_EQ(before.back(), 3.0);
  presenter.stop();
  const std::vector<double> after = run(presenter, 100);
  for (std::size_t i = 0; i < after.size(); ++i) {
    ASSERT_LT(after[i], i == 0 ? 3.0 : std::max(after[i - 1], 1e-12)) << i;
    if (i >= 30) {
      ASSERT_EQ(after[i], 0.0) << i;
    }
  }
  presenter.present(stimuli(1.0, 1.0));
  for (const double force_N : run(presenter, 2000)) ASSERT_EQ(force_N, 0.0);
}

TEST(StudyPresenter, ATickAllocatesAndLocksNothing) {
  if (!test::rt_guard_works()) GTEST_SKIP() << "a sanitizer owns malloc";
  const auto strokes = test::example_strokes(0.9);
  const Stimulus reference{1.0, &strokes->reference_N}, comparison{1.0, &strokes->comparison_N};
  const Stimuli three{reference, comparison, reference};
  StudyPresenter presenter;
  presenter.present(stimuli(1.0, 2.0));
  test::RtGuard guard;
  double rendered_N = 0.0;
  for (int i = 0; i < 10000; ++i) {
    if (i == 1000) presenter.present(three);
    if (i == 8000) presenter.present(stimuli(0.5, 0.6));
    if (i == 9000) presenter.stop();
    rendered_N = presenter.tick(rendered_N);
  }
  EXPECT_EQ(guard.stop().total(), 0);
}

}  // namespace
}  // namespace palpate
