// The closed loop with a simulated hand: every method's model of silicone and of
// the stiff block, and models of materials with memory (friction, softening, a fluid,
// a layer, a power law); an encoder of 30 or 5 um, ticks at 1 kHz, and one tick of force
// delay. The tests require no limit cycle at rest (this file), no energy generation
// (closed_loop_energy_test.cpp) and no force step when models are exchanged
// (closed_loop_exchange_test.cpp). A plain spring in the same loop fails, which shows
// that the tests detect such faults.
//
// Theory: a spring force that is held for a tick T and delayed by t_d acts as a
// spring K with the damping -K (T / 2 + t_d): -0.9 N s/m on 600 N/m, -4.5 N s/m
// on 3 kN/m (Colgate & Schenkel 1997, for t_d = 0). The viscosity of the model, the
// hand and the device must provide that much damping; the passivity controller
// (engine/live/passivity_controller.h) adds what is missing. Some tests switch it
// off to show its effect.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <string>

#include "tests/support/closed_loop_measures.h"
#include "tests/support/live_doubles.h"

namespace palpate::test {
namespace {

// A tool on an edge of the encoder may be in either of two steps, and the loop sees it
// move only when it enters a third. A hand cannot feel less than one JND.
// Measured: 1.7 steps and 0.6 JND.
constexpr double kStill_steps = 3.0;
constexpr double kStill_jnd = 1.0;

TEST(ClosedLoop, ComesToRestOnSiliconeInEveryHand) {
  for (const ModelPtr& model : silicone_models()) {
    Rest worst;
    for (const Grip& grip : grips()) {
      worst.keep_worse(worst_hold(model, grip, kFirm));
      if (held(grip)) worst.keep_worse(worst_hold(model, grip, kLight));
    }
    say("at rest, " + model->name(), "%.2f encoder steps, %.2f JND peak to peak", worst.position_steps,
        worst.force_jnd);
    EXPECT_LE(worst.position_steps, kStill_steps) << model->name();
    EXPECT_LE(worst.force_jnd, kStill_jnd) << model->name();
  }
  // For comparison: a spring of the same stiffness, without damping.
  EXPECT_GT(worst_hold(spring(kSoftSpring_N_per_m), mass_alone(), kFirm, 1.5, false).position_steps, 100.0);
}

// A force delay of 2 or 3 ms: every millisecond costs 0.6 N s/m of damping.
// Measured: 2.0 steps and 0.6 JND. A free mass keeps moving by 5.4 steps of 30 um, because the controller sees no
// motion within one step.
constexpr double kMassAlone_steps = 6.0;
TEST(ClosedLoop, ComesToRestOnSiliconeWithThreeMillisecondsOfDelay) {
  for (const double delay_s : {2e-3, 3e-3}) {
    Rest worst, alone;
    for (const ModelPtr& model : silicone_models()) {
      for (const Grip& grip : grips()) {
        for (const double encoder_m : kEncoders_m) {
          Rest& of = held(grip) ? worst : alone;
          of.keep_worse(hold(model, {grip, encoder_m, delay_s, Ticking::gaps}, kFirm, 2.0));
          if (held(grip)) worst.keep_worse(hold(model, {grip, encoder_m, delay_s, Ticking::gaps}, kLight, 2.0));
        }
      }
    }
    say("at rest, force " + std::to_string(std::lround(1e3 * delay_s)) + " ms late",
        "%.2f encoder steps, %.2f JND peak to peak", worst.position_steps, worst.force_jnd);
    std::cout << "a mass alone: " << alone.position_steps << " steps\n";
    EXPECT_LE(worst.position_steps, kStill_steps) << delay_s;
    EXPECT_LE(worst.force_jnd, kStill_jnd) << delay_s;
    EXPECT_LE(alone.position_steps, kMassAlone_steps) << delay_s;
  }
}

// Near its surface silicone has almost no viscosity, so that a free mass pushed with
// 0.3 N would keep bouncing by some millimetres: the held and late force of 450 N/m
// needs 0.7 N s/m of damping. The controller leaves the energy that one encoder step
// hides, 9 uJ at 0.3 N. Measured: 4.1 mm without the controller, 1.0 mm with it; with
// 1.5 N s/m in the device the mass comes to rest.
constexpr double kBounce_m = 1.5e-3;
constexpr double kEnoughDamping_Ns_per_m = 1.5;

TEST(ClosedLoop, AMassThatNothingHoldsBouncesOnTheSurfaceAndNoMore) {
  for (const ModelPtr& model : silicone_models()) {
    const Rest bare = worst_hold(model, mass_alone(), kLight, 2.5, false);
    const Rest passive = worst_hold(model, mass_alone(), kLight, 2.5);
    const Rest damped = worst_hold(model, {"damped", 0.1, 0.0, kEnoughDamping_Ns_per_m}, kLight, 2.5);
    say("light mass, " + model->name(), "bounces %.2f mm without the controller, %.2f mm with it",
        1e3 * bare.position_m, 1e3 * passive.position_m);
    EXPECT_LE(passive.position_m, kBounce_m) << model->name();
    EXPECT_LT(passive.position_m, bare.position_m) << model->name();
    EXPECT_LE(damped.position_steps, kStill_steps) << model->name();
    EXPECT_LE(damped.force_jnd, kStill_jnd) << model->name();
  }
}

// A rig that never leaves the material measures depth from a preload, here 0.9 N. The trend
// starts where that load would be 0 (models/samples/samples.h); a force step at the
// surface would make a relaxed finger buzz. Measured: 0.7 steps and 0.8 JND;
// a free mass that is pushed firmly keeps moving, by 27 steps.
TEST(ClosedLoop, ComesToRestInEveryHandOnAModelOfRecordingsThatBeginUnderLoad) {
  Recording recording;
  recording.name = "preloaded";
  for (int i = 0; i < 20000; ++i) {
    const double time_s = 1e-3 * i;
    const double position_m = 2e-3 * (1.0 - std::cos((4.0 + 0.5 * time_s) * time_s));
    const double velocity_m_per_s = 2e-3 * (4.0 + time_s) * std::sin((4.0 + 0.5 * time_s) * time_s);
    recording.rows.push_back(
        {time_s, position_m, kSoftSpring_N_per_m * (position_m + 1.5e-3) + 2.0 * velocity_m_per_s, 0.0, 0.0});
  }
  const auto shared = std::make_shared<const Recording>(recording);
  const ModelPtr model = fit(prepare({shared}, default_request("silicone_block")), &kGreedyMethod);
  EXPECT_NEAR(surface_position_m(model->features()), -1.5e-3, 0.1e-3);
  EXPECT_GT(judge(recording, model).within_jnd, 0.95);
  Rest worst;
  for (const Grip& grip : grips()) {
    if (!held(grip)) continue;
    worst.keep_worse(worst_hold(model, grip, kFirm));
    worst.keep_worse(worst_hold(model, grip, kLight));
  }
  say("at rest, recorded under load", "%.2f encoder steps, %.2f JND peak to peak", worst.position_steps,
      worst.force_jnd);
  EXPECT_LE(worst.position_steps, kStill_steps);
  EXPECT_LE(worst.force_jnd, kStill_jnd);
}

// Known limitation: one step of 30 um is 0.35 JND on 3 kN/m, and a relaxed hand
// has less damping than the 4.5 N s/m that the block requires. With such an
// encoder it feels a buzz of 2 JND. Measured: 3.9 steps, 2.0 JND; with a 5 um
// encoder 0.3 JND.
constexpr double kStiffStill_steps = 6.0;
constexpr double kStiffStill_jnd = 3.0;
constexpr double kFineStill_jnd = 0.5;

TEST(ClosedLoop, TheStiffBlockIsStableInAHand) {
  for (const ModelPtr& model : stiff_models()) {
    Rest worst, fine;
    for (const Grip& grip : grips()) {
      if (!held(grip)) continue;
      worst.keep_worse(worst_hold(model, grip, kFirmOnStiff, 3.0));
      fine.keep_worse(hold(model, {grip, 5e-6, kOneTick_s, Ticking::gaps}, kFirmOnStiff, 3.0));
    }
    say("stiff, at rest, " + model->name(), "%.2f encoder steps, %.2f JND peak to peak", worst.position_steps,
        worst.force_jnd);
    say("stiff, with 5 um, " + model->name(), "%.2f encoder steps, %.2f JND peak to peak", fine.position_steps,
        fine.force_jnd);
    EXPECT_LE(worst.position_steps, kStiffStill_steps) << model->name();
    EXPECT_LE(worst.force_jnd, kStiffStill_jnd) << model->name();
    EXPECT_LE(fine.force_jnd, kFineStill_jnd) << model->name();
  }
  // For comparison: a spring of the same stiffness, without viscosity, never comes to rest.
  EXPECT_GT(worst_hold(spring(kStiffSpring_N_per_m), grips()[0], kFirmOnStiff, 3.0, false).force_jnd, 10.0);
}

// A free mass gains energy from the held and late force of the stiff block and oscillates
// widely. The controller reduces this to a buzz of some encoder steps; with 6 N s/m in the
// device the mass comes to rest. Measured: 137 mm without the controller, 0.2 mm with it.
constexpr double kBuzz_m = 0.4e-3;

TEST(ClosedLoop, TheStiffBlockDoesNotThrowAMassAbout) {
  for (const ModelPtr& model : stiff_models()) {
    const Rest bare = worst_hold(model, mass_alone(), kFirmOnStiff, 3.0, false);
    const Rest passive = worst_hold(model, mass_alone(), kFirmOnStiff, 3.0);
    const Rest damped = worst_hold(model, {"damped", 0.1, 0.0, 6.0}, kFirmOnStiff, 3.0);
    say("stiff, mass alone, " + model->name(), "moves %.2f mm without the controller, %.2f mm with it",
        1e3 * bare.position_m, 1e3 * passive.position_m);
    EXPECT_GT(bare.position_m, 10.0 * kBuzz_m) << model->name() << ": is the controller needed?";
    EXPECT_LE(passive.position_m, kBuzz_m) << model->name();
    EXPECT_LE(passive.largest_N, 1.2 * model->data().largest_force_N) << model->name();
    EXPECT_LE(damped.position_steps, kStiffStill_steps) << model->name();
    EXPECT_LE(damped.force_jnd, kStiffStill_jnd) << model->name();
  }
}

// The materials with memory are three to ten times as stiff as silicone (2 kN/m, and
// 7 kN/m before friction slips), so that a held and late force needs 3 to 10 N s/m of
// damping. A firm hand has that much and feels at most the encoder step. A relaxed finger has
// 3.5 N s/m and feels a buzz that neither grows nor ends. Measured with 1 and 3 ms of delay:
// firm 0.97 JND, on friction 2.96 JND; relaxed 10.4 JND and 0.82 mm, but below 1 JND on tissue
// and softening foam with 1 ms. Known limitation: the sponge has an instantaneous stiffness of
// 3.3 kN/m. With 3 ms of delay a relaxed finger on it oscillates by 4.2 mm, 21 JND; with 1 ms
// by 1.1 JND.
constexpr double kFirmStill_jnd = 1.2;
constexpr double kFirmOnFriction_jnd = 4.0;
constexpr double kRelaxedBuzz_jnd = 12.0;
constexpr double kRelaxedBuzz_m = 1.2e-3;
constexpr double kLateOnSponge_jnd = 25.0;
constexpr double kLateOnSponge_m = 5e-3;

TEST(ClosedLoop, ComesToRestOnMaterialsWithMemory) {
  for (const char* material : kMaterialsWithMemory) {
    for (const FeatureSpec& spec : loop_models(material).front()->features())
      std::printf("%s: %s\n", material, feature_name(spec).c_str());
    for (const ModelPtr& model : loop_models(material)) {
      for (const Grip& grip : grips()) {
        if (!held(grip)) continue;
        for (const double encoder_m : kEncoders_m) {
          for (const double delay_s : {1e-3, 3e-3}) {
            const Rest rest = hold(model, {grip, encoder_m, delay_s, Ticking::gaps}, half_press(model), 3.0);
            const std::string row = std::string(material) + " " + model->name() + " " + grip.name + " " +
                                    std::to_string(std::lround(1e6 * encoder_m)) + " um " +
                                    std::to_string(std::lround(1e3 * delay_s)) + " ms";
            say("at rest, " + row, "%.2f encoder steps, %.2f JND peak to peak", rest.position_steps, rest.force_jnd);
            const bool relaxed = grip.name == "relaxed";
            const bool thrown = relaxed && std::string(material) == "sponge" && delay_s > kOneTick_s;
            const double firm_jnd = std::string(material) == "friction" ? kFirmOnFriction_jnd : kFirmStill_jnd;
            const double relaxed_jnd = thrown ? kLateOnSponge_jnd : kRelaxedBuzz_jnd;
            const double relaxed_m = thrown ? kLateOnSponge_m : kRelaxedBuzz_m;
            EXPECT_LE(rest.force_jnd, relaxed ? relaxed_jnd : firm_jnd) << row;
            EXPECT_LE(rest.position_m, relaxed ? relaxed_m : 0.1e-3) << row;
            EXPECT_LE(rest.largest_N, 1.2 * model->data().largest_force_N) << row;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace palpate::test
