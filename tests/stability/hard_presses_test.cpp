#include "tests/stability/hard_presses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// The branch has decayed by e^-12 after two seconds.
TEST(HardPresses, AHoldEndsAtTheSpringsForce) {
  const Press press = press_along([](double t) { return 0.004 * std::min(1.0, 10.0 * t); }, even_times(2.2, 100.0));
  EXPECT_NEAR(press.true_N.back(), 300.0 * 0.004 + 2e4 * 0.004 * 0.004, 1e-5);
}

// On a ramp dz/dt = 100 v - z / 0.17 s: z = 17 v (1 - exp(-t / 0.17 s)).
TEST(HardPresses, ARampHasTheClosedFormOfItsBranch) {
  const double v = 0.02;
  const Press press = press_along([=](double t) { return v * t; }, even_times(0.3, 1000.0));
  for (std::size_t i = 10; i < press.true_N.size(); ++i) {
    const double t = press.recording.rows[i].time_s;
    const double d = v * t;
    const double expected = 300.0 * d + 2e4 * d * d + 2.0 * v + 17.0 * v * (1.0 - std::exp(-t / 0.17));
    EXPECT_NEAR(press.true_N[i], expected, 1e-9) << t;
  }
}

TEST(HardPresses, SensorsRoundAndAddNoiseAndAirDoesNotPush) {
  const Press press =
      press_along(training_path(0), even_times(3.0, 500.0), {.force_noise_N = 0.01, .encoder_step_m = 1e-4});
  double squares = 0.0;
  bool in_air = false;
  for (std::size_t i = 0; i < press.true_N.size(); ++i) {
    const RecordingRow& row = press.recording.rows[i];
    EXPECT_NEAR(row.position_m / 1e-4, std::round(row.position_m / 1e-4), 1e-9);
    squares += std::pow(row.force_N - press.true_N[i], 2);
    EXPECT_GE(press.true_N[i], 0.0);
    if (row.position_m < 0.0) {
      in_air = true;
      EXPECT_EQ(press.true_N[i], 0.0);
    }
  }
  EXPECT_TRUE(in_air);
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(press.true_N.size())), 0.01, 0.001);
}

}  // namespace
}  // namespace palpate
