// Energy in the closed loop (closed_loop_test.cpp): cycles and strokes absorb more energy
// than they return.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support/closed_loop_energy.h"
#include "tests/support/live_doubles.h"

namespace palpate::test {
namespace {

TEST(ClosedLoop, NoCycleInSiliconeGivesEnergy) {
  for (const ModelPtr& model : silicone_models()) {
    // The model alone is passive, without the controller.
    const double least = least_damping_Ns_per_m(model, kFirm.depth_m, false);
    say("cycles, " + model->name(), "damping of %.2f N s/m or more, %.2f needed", least, 0.0);
    EXPECT_GE(least, 0.0) << model->name();
  }
  // The result of a spring has a closed form; at 40 Hz it is a tenth larger.
  for (const double stiffness : {kSoftSpring_N_per_m, kStiffSpring_N_per_m}) {
    const double expected = held_and_late_Ns_per_m(stiffness);
    EXPECT_NEAR(least_damping_Ns_per_m(spring(stiffness), kFirmOnStiff.depth_m, 5e-6, 5e-4, Ticking::even, false),
                expected, -0.2 * expected);
  }
}

// An encoder reverses a step late at the turn, on the way in and out. So a stroke may
// return at most one step times the largest force more than it absorbed.
// Silicone absorbs a fifth of every stroke and returns less than it took.
TEST(ClosedLoop, StrokesIntoSiliconeGiveLessThanTheyTake) {
  for (const ModelPtr& model : silicone_models()) {
    double worst_return = 0.0, worst_bounce = 0.0;
    for (const Grip& grip : grips()) {
      for (const double encoder_m : kEncoders_m) {
        for (const Ticking ticking : {Ticking::even, Ticking::jittered, Ticking::gaps}) {
          const Strokes strokes = stroke(model, {grip, encoder_m, kOneTick_s, ticking}, kFirm);
          double& worst = held(grip) ? worst_return : worst_bounce;
          worst = std::max(worst, strokes.worst_return);
          if (held(grip)) {
            EXPECT_GE(strokes.lowest_J, -encoder_m * strokes.largest_N) << model->name() << ", " << grip.name;
          }
        }
      }
    }
    say("strokes, " + model->name(), "%.1f %% comes out again, of a thrown mass %.1f %%", 100.0 * worst_return,
        100.0 * worst_bounce);
    EXPECT_LE(worst_return, 1.0) << model->name();
    // A mass thrown at the surface stays where silicone has little viscosity, and one
    // encoder step hides energy. Measured: 1.09; 1.19 without the controller.
    EXPECT_LE(worst_bounce, 1.15) << model->name();
  }
  for (const Grip& grip : grips()) {
    LoopSettings settings{grip, 5e-6, kOneTick_s, Ticking::even};
    settings.passivity = false;
    EXPECT_GT(stroke(spring(kSoftSpring_N_per_m), settings, kFirm).worst_return, 1.2) << grip.name;
  }
}

// The force that the controller takes away in a hand, in JNDs: none on silicone, which
// absorbs a fifth of every stroke; on the stiff block the excess that a held and delayed force
// returns on the way out. Measured: silicone 0 JND; stiff block 0.67 JND (mean of all
// ticks in contact) and 13 JND (largest, when the tool leaves the block within 50 ms).
TEST(ClosedLoop, TheControllerCostsAHandLessThanOneJnd) {
  const auto cost = [](const std::string& block, const std::vector<ModelPtr>& models, const Press& press) {
    Strokes worst;
    for (const ModelPtr& model : models) {
      for (const Grip& grip : grips()) {
        if (!held(grip)) continue;
        for (const double encoder_m : kEncoders_m) {
          const Strokes strokes = stroke(model, {grip, encoder_m, kOneTick_s, Ticking::gaps}, press);
          worst.mean_cost_jnd = std::max(worst.mean_cost_jnd, strokes.mean_cost_jnd);
          worst.largest_cost_jnd = std::max(worst.largest_cost_jnd, strokes.largest_cost_jnd);
        }
      }
    }
    say("passivity costs on " + block, "%.3f JND mean, %.2f JND at most", worst.mean_cost_jnd, worst.largest_cost_jnd);
    return worst;
  };
  EXPECT_LE(cost("silicone", silicone_models(), kFirm).largest_cost_jnd, 0.1);
  EXPECT_LE(cost("the stiff block", stiff_models(), kFirmOnStiff).mean_cost_jnd, 1.0);
}

}  // namespace
}  // namespace palpate::test
