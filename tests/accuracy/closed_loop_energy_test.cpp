// Energy in the closed loop (closed_loop_test.cpp): cycles and strokes absorb more energy
// than they return.
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/support/closed_loop_measures.h"

namespace palpate::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// What cycles (in N s/m of damping) and strokes of a hand may do at most.
struct EnergyLimits {
  const char* material;
  double least_damping_Ns_per_m;
  double worst_return = 1.0;
  double beyond_step_J = 0.0;
  double mean_cost_jnd = 1.0;
  double largest_cost_jnd = kInfinity;
  bool every_ticking = false;  // in strokes; else only the worst one, Ticking::gaps
};

// The controller takes nothing away from a hand on silicone.
// The stiff block: its own viscosity helps against the damping of a held and late force, -4.5 N s/m. Measured cost:
// 0.67 JND (mean of all ticks in contact) and 13 JND (largest, when the tool leaves the block within 50 ms).
// The others: a held and late force of up to 4 kN/m acts like -6 N s/m. With the controller it lacks less than the
// 3.5 N s/m of a relaxed finger. Measured: -1.65 (sponge), -0.62 (layered) to 2.3 (friction); returned 0.95.
// Known limitation: the sponge (17 N at 3.3 kN/m) returns up to 106 % of the energy of a stroke and a surplus of up to
// 6.8 mJ. The controller, limited to 12 N s/m, cannot dissipate that within 50 ms.
const EnergyLimits kLimits[] = {
    {.material = "maxwell", .least_damping_Ns_per_m = 0.0, .largest_cost_jnd = 0.1, .every_ticking = true},
    {.material = "stiff",
     .least_damping_Ns_per_m = held_and_late_Ns_per_m(kStiffSpring_N_per_m),
     .worst_return = kInfinity,
     .beyond_step_J = kInfinity},
    {.material = "friction", .least_damping_Ns_per_m = -2.0},
    {.material = "sponge", .least_damping_Ns_per_m = -2.0, .worst_return = 1.25, .beyond_step_J = 0.01},
    {.material = "layered", .least_damping_Ns_per_m = -2.0},
};

HandPress press_of(const std::string& material, const ModelPtr& model) {
  if (material == "maxwell") return kFirm;
  return material == "stiff" ? kFirmOnStiff : half_press(model);
}

TEST(ClosedLoop, CyclesGiveLessEnergyThanAFingerTakes) {
  for (const EnergyLimits& limits : kLimits) {
    for (const ModelPtr& model : loop_models(limits.material)) {
      const std::string who = std::string(limits.material) + ", " + model->name();
      const double least = least_damping_Ns_per_m(model, press_of(limits.material, model).depth_m);
      say("cycles, " + who, "damping of %.2f N s/m or more, %.2f needed", least, limits.least_damping_Ns_per_m);
      EXPECT_GE(least, limits.least_damping_Ns_per_m) << who;
    }
  }
}

// An encoder reverses a step late at the turn, on the way in and out. So a stroke may
// return at most one step times the largest force more than it absorbed. The cost is the
// force that the controller takes away in a hand, in JNDs.
TEST(ClosedLoop, StrokesOfAHandGiveLessThanTheyTake) {
  for (const EnergyLimits& limits : kLimits) {
    for (const ModelPtr& model : loop_models(limits.material)) {
      const std::string who = std::string(limits.material) + ", " + model->name();
      Strokes worst;
      for (const Grip& grip : kGrips) {
        if (!held(grip)) continue;
        for (const double encoder_m : kEncoders_m) {
          for (const Ticking ticking : kTickings) {
            if (ticking != Ticking::gaps && !limits.every_ticking) continue;
            worst.keep_worse(
                stroke(model, {grip, encoder_m, kOneTick_s, ticks(ticking)}, press_of(limits.material, model)));
          }
        }
      }
      say("strokes, " + who, "%.1f %% comes out again, passivity costs %.3f JND on the mean",
          100.0 * worst.worst_return, worst.mean_cost_jnd);
      EXPECT_LE(worst.worst_return, limits.worst_return) << who;
      EXPECT_LE(worst.beyond_step_J, limits.beyond_step_J) << who;
      EXPECT_LE(worst.mean_cost_jnd, limits.mean_cost_jnd) << who;
      EXPECT_LE(worst.largest_cost_jnd, limits.largest_cost_jnd) << who;
    }
  }
}

// A mass thrown at the surface, at 0.0125 to 0.1 m/s, stays where silicone has little viscosity. The passivity
// controller does not see the energy of one encoder step: each throw returns at most that more than it put in, 0.7 to
// 31 % of it.
TEST(ClosedLoop, AMassThrownAtSiliconeReturnsLittleMoreEnergyThanItHad) {
  for (const ModelPtr& model : silicone_models()) {
    for (const double encoder_m : kEncoders_m) {
      for (const Ticking ticking : kTickings) {
        ClosedLoopSettings settings{mass_alone(), encoder_m, kOneTick_s, ticks(ticking)};
        EXPECT_LE(stroke(model, settings, kFirm).own_beyond_step_J, 0.0) << model->name() << ", " << encoder_m;
      }
    }
  }
}

}  // namespace
}  // namespace palpate::test
