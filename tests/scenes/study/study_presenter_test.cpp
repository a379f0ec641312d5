#include "scenes/study/study_presenter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/rt_guard.h"
#include "tests/support/study_driving.h"

namespace palpate {
namespace {

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
