#include "scenes/study/study_presenter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/rt_guard.h"
#include "tests/support/study_driving.h"

namespace palpate {
namespace {

const StudyTiming kTiming{40, 60, 100, 50};

Stimuli stimuli(double first_N, double second_N) { return {{first_N}, {second_N}, false, {}}; }

// The forces of `ticks` ticks, each rendered as it is.
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

TEST(StudyPresenter, PresentsBothForcesExactToTheTick) {
  StudyPresenter presenter(kTiming);
  for (const double force_N : run(presenter, 100)) ASSERT_EQ(force_N, 0.0) << "idle";
  EXPECT_EQ(presenter.present(stimuli(1.0, 2.5)), 1u);
  const std::vector<double> forces = run(presenter, kTiming.presentation() + 100);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    SCOPED_TRACE(i);
    const bool first_held = i >= 40 + 60 && i < 40 + 160;
    const bool second_held = i >= 40 + 220 + 50 + 60 && i < 40 + 220 + 50 + 160;
    const bool silent = i <= 40 || (i >= 40 + 219 && i <= 40 + 220 + 50) || i + 1 >= kTiming.presentation();
    if (first_held || second_held || silent) {
      ASSERT_EQ(forces[i], first_held ? 1.0 : second_held ? 2.5 : 0.0);
    } else {
      ASSERT_TRUE(forces[i] > 0.0 && forces[i] < 2.5);
    }
  }
  const PresentationState& state = presenter.newest();
  EXPECT_EQ(state.phase, PresentationPhase::finished);
  EXPECT_EQ(state.presentation, 1u);
  EXPECT_EQ(state.finished_at, 100u + kTiming.presentation());
  EXPECT_EQ(state.tick, 100u + kTiming.presentation() + 100u);
  EXPECT_FALSE(state.limited) << "the ramps stay below the limiter's slew";
}

TEST(StudyPresenter, RecordsWhatWasRenderedNotWhatWasWanted) {
  StudyPresenter presenter(kTiming);
  presenter.present(stimuli(1.0, 2.0));
  run(presenter, kTiming.presentation() + 2, 0.9);
  EXPECT_NEAR(presenter.newest().first_rendered_N, 0.9, 1e-12);
  EXPECT_NEAR(presenter.newest().second_rendered_N, 1.8, 1e-12);
}

TEST(StudyPresenter, LimitsAForceThatIsTooLarge) {
  StudyPresenter presenter(kTiming);
  presenter.present(stimuli(50.0, std::nan("")));
  const std::vector<double> forces = run(presenter, kTiming.presentation() + 2);
  EXPECT_EQ(*std::max_element(forces.begin(), forces.end()), kLargestStudyForce_N);
  for (std::size_t i = 1; i < forces.size(); ++i) ASSERT_LE(std::abs(forces[i] - forces[i - 1]), 0.1 + 1e-9);
  EXPECT_TRUE(presenter.newest().limited);
  EXPECT_EQ(presenter.newest().second_rendered_N, 0.0);
}

TEST(StudyPresenter, NoForceOutlastsItsIntervalWhenNobodyComesBack) {
  StudyPresenter presenter(kTiming);
  presenter.present(stimuli(1.0, 2.0));
  run(presenter, kTiming.presentation());
  for (const double force_N : run(presenter, 20000)) ASSERT_EQ(force_N, 0.0);
}

TEST(StudyPresenter, StopsAtOnceAndForGood) {
  StudyPresenter presenter(kTiming);
  presenter.present(stimuli(3.0, 2.0));
  const std::vector<double> before = run(presenter, 150);
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
  EXPECT_EQ(presenter.newest().phase, PresentationPhase::stopped);
}

TEST(StudyPresenter, ATickAllocatesAndLocksNothing) {
  if (!test::rt_guard_works()) GTEST_SKIP() << "a sanitizer owns malloc";
  StudyPresenter presenter(kTiming);
  presenter.present(stimuli(1.0, 2.0));
  test::RtGuard guard;
  double rendered_N = 0.0;
  for (int i = 0; i < 10000; ++i) {
    if (i == 1000) presenter.present(stimuli(0.5, 0.6));
    if (i == 1200) presenter.stop();
    rendered_N = presenter.tick(rendered_N);
  }
  EXPECT_EQ(guard.stop().total(), 0);
}

TEST(StudyPresenter, RefusesTimingsThatLastTooLongOrKick) {
  EXPECT_TRUE(check_study_timing({}).ok());
  EXPECT_EQ(check_study_timing({400, 10, 900, 500}).error().message, "found a ramp of 10 ms, expected 60 to 5000 ms");
  EXPECT_EQ(check_study_timing({400, 100, 4801, 500}).error().message,
            "found a hold of 4801 ms, expected 1 ms or more, and 5000 ms at most together with both ramps");
  EXPECT_FALSE(check_study_timing({400, 100, 0, 500}).ok());
  EXPECT_FALSE(check_study_timing({400, 100, 4294967295u, 500}).ok());
  EXPECT_FALSE(check_study_timing({60001, 100, 900, 500}).ok());
  EXPECT_FALSE(check_study_timing({400, 100, 900, 60001}).ok());
}

TEST(StudyPresenter, PlaysStrokesBehindAReminderExactToTheTick) {
  const auto strokes = test::example_strokes(0.9);
  const StudyTiming& timing = test::kQuickTiming;  // lead-in 5, ramp 60, hold 20, pause 5
  StudyPresenter presenter(timing, strokes);
  const Stimulus reference{1.0, StimulusKind::reference}, comparison{1.0, StimulusKind::comparison};
  presenter.present({comparison, reference, true, {0.5, StimulusKind::reference}});
  const std::size_t interval = timing.interval(), pause = timing.pause, lead_in = timing.lead_in;
  const std::vector<double> forces = run(presenter, lead_in + 3 * interval + 2 * pause + 50);
  const auto share = [&](std::size_t i) {  // half a cosine at either end
    const std::size_t edge = std::min(i, interval - 1 - i);
    return edge >= 60 ? 1.0 : 0.5 - 0.5 * std::cos(std::acos(-1.0) * static_cast<double>(edge) / 60.0);
  };
  for (std::size_t i = 0; i < forces.size(); ++i) {
    SCOPED_TRACE(i);
    double expected_N = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t begin = lead_in + k * (interval + pause);
      if (i < begin || i >= begin + interval) continue;
      const std::size_t at = i - begin;
      expected_N = share(at) * (k == 0   ? 0.5 * strokes->reference_N[at]
                                : k == 1 ? strokes->comparison_N[at]
                                         : strokes->reference_N[at]);
    }
    ASSERT_NEAR(forces[i], expected_N, 1e-12);
  }
  const PresentationState& state = presenter.newest();
  EXPECT_EQ(state.finished_at, lead_in + 3 * interval + 2 * pause);
  EXPECT_NEAR(state.reminder_rendered_N, 0.5 * strokes->reference_mean_N, 1e-4);
  EXPECT_NEAR(state.first_rendered_N, strokes->comparison_mean_N, 1e-4);
  EXPECT_NEAR(state.second_rendered_N, strokes->reference_mean_N, 1e-4);
  EXPECT_NEAR(state.worst_N, 0.0, 1e-12);
  EXPECT_FALSE(state.limited);
}

TEST(StudyPresenter, TellsHowFarWhatWasRenderedWasFromTheStroke) {
  StudyPresenter presenter(test::kQuickTiming, test::example_strokes(1.0));
  presenter.present(
      {{1.0, StimulusKind::reference}, {1.0, StimulusKind::reference}, true, {1.0, StimulusKind::reference}});
  run(presenter, 600, 0.9);
  double largest_N = 0.0;
  for (std::uint32_t i = 0; i < 140; ++i)
    largest_N = std::max(largest_N, interval_share(test::kQuickTiming, i) * (1.0 + 0.01 * i));
  EXPECT_NEAR(presenter.newest().worst_N, 0.1 * largest_N, 1e-9);
}

TEST(StudyPresenter, LimitsStrokesAndEndsThem) {
  auto strong = std::make_shared<StrokePair>(*test::example_strokes(1.0));
  strong->comparison_N.assign(70, 50.0);  // too strong and too short
  StudyPresenter presenter(test::kQuickTiming, strong);
  const Stimulus comparison{1.0, StimulusKind::comparison};
  presenter.present({comparison, comparison, true, comparison});
  const std::vector<double> forces = run(presenter, 1000);
  EXPECT_EQ(*std::max_element(forces.begin(), forces.end()), kLargestStudyForce_N);
  for (std::size_t i = 1; i < forces.size(); ++i) ASSERT_LE(std::abs(forces[i] - forces[i - 1]), 0.1 + 1e-9);
  for (std::size_t i = 500; i < forces.size(); ++i) ASSERT_EQ(forces[i], 0.0);
  EXPECT_TRUE(presenter.newest().limited);
}

TEST(StudyPresenter, ATickOfAStrokeAllocatesAndLocksNothing) {
  if (!test::rt_guard_works()) GTEST_SKIP() << "a sanitizer owns malloc";
  StudyPresenter presenter(test::kQuickTiming, test::example_strokes(0.9));
  presenter.present(
      {{1.0, StimulusKind::reference}, {1.0, StimulusKind::comparison}, true, {1.0, StimulusKind::reference}});
  test::RtGuard guard;
  double rendered_N = 0.0;
  for (int i = 0; i < 1000; ++i) rendered_N = presenter.tick(rendered_N);
  EXPECT_EQ(guard.stop().total(), 0);
}

}  // namespace
}  // namespace palpate
