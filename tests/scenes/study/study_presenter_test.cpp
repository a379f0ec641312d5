#include "scenes/study/study_presenter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/rt_guard.h"
#include "tests/support/study_driving.h"

namespace palpate {
namespace {

constexpr std::uint32_t kPresentation_ticks = kLeadIn_ticks + 2 * kInterval_ticks + kPause_ticks;

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

TEST(StudyPresenter, PresentsBothForcesExactToTheTick) {
  StudyPresenter presenter;
  for (const double force_N : run(presenter, 100)) ASSERT_EQ(force_N, 0.0) << "idle";
  EXPECT_EQ(presenter.present(stimuli(1.0, 2.5)), 1u);
  const std::vector<double> forces = run(presenter, kPresentation_ticks + 100);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    SCOPED_TRACE(i);
    const std::size_t second = kLeadIn_ticks + kInterval_ticks + kPause_ticks;
    const auto held = [&](std::size_t begin) {
      return i >= begin + kRamp_ticks && i < begin + kRamp_ticks + kHold_ticks;
    };
    const bool first_held = held(kLeadIn_ticks), second_held = held(second);
    const bool silent =
        i <= kLeadIn_ticks || (i + 1 >= kLeadIn_ticks + kInterval_ticks && i <= second) || i + 1 >= kPresentation_ticks;
    if (first_held || second_held || silent) {
      ASSERT_EQ(forces[i], first_held ? 1.0 : second_held ? 2.5 : 0.0);
    } else {
      ASSERT_TRUE(forces[i] > 0.0 && forces[i] < 2.5);
    }
  }
  const PresentationState& state = presenter.newest();
  EXPECT_EQ(state.presentation, 1u);
  EXPECT_EQ(state.finished_at, 100u + kPresentation_ticks);
  EXPECT_EQ(state.tick, 100u + kPresentation_ticks + 100u);
  EXPECT_FALSE(state.limited) << "the ramps stay below the limiter's slew";
}

TEST(StudyPresenter, RecordsWhatWasRenderedNotWhatWasWanted) {
  StudyPresenter presenter;
  presenter.present(stimuli(1.0, 2.0));
  run(presenter, kPresentation_ticks + 2, 0.9);
  EXPECT_NEAR(presenter.newest().rendered_N[1], 0.9, 1e-12);
  EXPECT_NEAR(presenter.newest().rendered_N[2], 1.8, 1e-12);
}

TEST(StudyPresenter, LimitsAForceThatIsTooLarge) {
  StudyPresenter presenter;
  presenter.present(stimuli(50.0, std::nan("")));
  const std::vector<double> forces = run(presenter, kPresentation_ticks + 2);
  EXPECT_EQ(*std::max_element(forces.begin(), forces.end()), kLargestStudyForce_N);
  for (std::size_t i = 1; i < forces.size(); ++i) ASSERT_LE(std::abs(forces[i] - forces[i - 1]), 0.1 + 1e-9);
  EXPECT_TRUE(presenter.newest().limited);
  EXPECT_EQ(presenter.newest().rendered_N[2], 0.0);
}

TEST(StudyPresenter, NoForceOutlastsItsIntervalWhenNobodyComesBack) {
  StudyPresenter presenter;
  presenter.present(stimuli(1.0, 2.0));
  run(presenter, kPresentation_ticks);
  for (const double force_N : run(presenter, 20000)) ASSERT_EQ(force_N, 0.0);
}

TEST(StudyPresenter, StopsAtOnceAndForGood) {
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

TEST(StudyPresenter, PlaysStrokesBehindAReminderExactToTheTick) {
  const auto strokes = test::example_strokes(0.9);
  StudyPresenter presenter;
  const Stimulus reference{1.0, &strokes->reference_N}, comparison{1.0, &strokes->comparison_N};
  presenter.present({Stimulus{0.5, &strokes->reference_N}, comparison, reference});
  const std::size_t interval = kInterval_ticks, pause = kPause_ticks, lead_in = kLeadIn_ticks;
  const std::vector<double> forces = run(presenter, lead_in + 3 * interval + 2 * pause + 50);
  const auto share = [&](std::size_t i) {  // half a cosine at either end
    const std::size_t edge = std::min(i, interval - 1 - i);
    return edge >= kRamp_ticks ? 1.0 : 0.5 - 0.5 * std::cos(std::acos(-1.0) * static_cast<double>(edge) / kRamp_ticks);
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
  EXPECT_NEAR(state.rendered_N[0], 0.5 * strokes->reference_mean_N, 1e-4);
  EXPECT_NEAR(state.rendered_N[1], strokes->comparison_mean_N, 1e-4);
  EXPECT_NEAR(state.rendered_N[2], strokes->reference_mean_N, 1e-4);
  EXPECT_NEAR(state.worst_N, 0.0, 1e-12);
  EXPECT_FALSE(state.limited);
}

TEST(StudyPresenter, TellsHowFarWhatWasRenderedWasFromTheStroke) {
  const auto strokes = test::example_strokes(1.0);
  const Stimulus reference{1.0, &strokes->reference_N};
  StudyPresenter presenter;
  presenter.present({reference, reference, reference});
  run(presenter, 6000, 0.9);
  double largest_N = 0.0;
  for (std::uint32_t i = 0; i < kInterval_ticks; ++i)
    largest_N = std::max(largest_N, interval_share(i) * strokes->reference_N[i]);
  EXPECT_NEAR(presenter.newest().worst_N, 0.1 * largest_N, 1e-9);
}

TEST(StudyPresenter, LimitsStrokesAndEndsThem) {
  const std::vector<double> strong(700, 50.0);  // shorter than an interval
  const Stimulus stimulus{1.0, &strong};
  StudyPresenter presenter;
  presenter.present({stimulus, stimulus, stimulus});
  const std::vector<double> forces = run(presenter, 6000);
  EXPECT_EQ(*std::max_element(forces.begin(), forces.end()), kLargestStudyForce_N);
  for (std::size_t i = 1; i < forces.size(); ++i) ASSERT_LE(std::abs(forces[i] - forces[i - 1]), 0.1 + 1e-9);
  for (std::size_t i = 5000; i < forces.size(); ++i) ASSERT_EQ(forces[i], 0.0);
  EXPECT_TRUE(presenter.newest().limited);
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
