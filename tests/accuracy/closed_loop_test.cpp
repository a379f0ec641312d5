// The loop closed over a hand that feels the force: every method's model of
// silicone and of the stiff block behind an encoder of 30 or 5 um, a tick at
// 1 kHz, and a force that comes one tick late. No limit cycle at rest, no energy
// out of nothing, no step when models change. A plain spring in the same loop
// shows what these tests can tell.
//
// What to expect. A force that is held for a tick T and comes t_d late acts as a
// spring K beside the damping -K (T / 2 + t_d): -0.9 N s/m on 600 N/m, -4.5 N s/m
// on 3 kN/m (Colgate & Schenkel 1997, for t_d = 0). Somebody has to provide as
// much: the model's own viscosity, the hand, the device, or, for the rest, the
// passivity controller (engine/live/passivity_controller.h). What it is needed for is
// shown without it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/example_model.h"
#include "tests/support/closed_loop_rest.h"
#include "tests/support/fitting.h"
#include "tests/support/live_doubles.h"
#include "tests/support/rt_guard.h"

namespace palpate {
namespace {

using test::ClosedLoop;
using test::ForcePtr;
using test::Grip;
using test::held;
using test::hold;
using test::kEncoders_m;
using test::kOneTick_s;
using test::LoopEnergy;
using test::LoopSettings;
using test::mass_alone;
using test::ModelPtr;
using test::Press;
using test::Rest;
using test::silicone_models;
using test::spring;
using test::stiff_models;
using test::Ticking;
using test::worst_hold;

constexpr Press kFirm{3.0, 5e-3};
constexpr Press kLight{0.3, 0.6e-3};
constexpr Press kFirmOnStiff{3.0, 1e-3};

constexpr double kSoftSpring_N_per_m = 600.0;  // as silicone at 3 N
constexpr double kStiffSpring_N_per_m = 3000.0;

// Of a force that is held for a tick and comes late; negative damping.
double held_and_late_Ns_per_m(double stiffness_N_per_m) {
  return -stiffness_N_per_m * (0.5 * kOneTick_s + kOneTick_s);
}

void say(const std::string& who, const char* format, double first, double second) {
  char figures[120];
  std::snprintf(figures, sizeof figures, format, first, second);
  std::cout << who << ": " << figures << '\n';
}

// Not a hand: it leads the tool where it wants.
Grip lead() { return {"lead", 1.0, 4e5, 1200.0}; }

// ---- At rest ----

// An encoder says in which of its steps the tool is: one that lies on an edge is in
// either of two, and the loop sees it leave only when it enters a third. One JND
// is what a hand can feel at all. Measured: 1.7 steps and 0.6 JND.
constexpr double kStill_steps = 3.0;
constexpr double kStill_jnd = 1.0;

TEST(ClosedLoop, ComesToRestOnSiliconeInEveryHand) {
  for (const ModelPtr& model : silicone_models()) {
    Rest worst;
    for (const Grip& grip : test::grips()) {
      worst.keep_worse(worst_hold(model, grip, kFirm));
      if (held(grip)) worst.keep_worse(worst_hold(model, grip, kLight));
    }
    say("at rest, " + model->name(), "%.2f encoder steps, %.2f JND peak to peak", worst.position_steps,
        worst.force_jnd);
    EXPECT_LE(worst.position_steps, kStill_steps) << model->name();
    EXPECT_LE(worst.force_jnd, kStill_jnd) << model->name();
  }
  // A spring of the same stiffness has no damping to give.
  EXPECT_GT(worst_hold(spring(kSoftSpring_N_per_m), mass_alone(), kFirm, 1.5, false).position_steps, 100.0);
}

// A transport that takes 2 or 3 ms: every millisecond costs 0.6 N s/m of damping.
// Measured: 2.0 steps and 0.6 JND.
TEST(ClosedLoop, ComesToRestOnSiliconeWithThreeMillisecondsOfDelay) {
  for (const double delay_s : {2e-3, 3e-3}) {
    Rest worst;
    for (const ModelPtr& model : silicone_models()) {
      for (const Grip& grip : test::grips()) {
        for (const double encoder_m : kEncoders_m) {
          worst.keep_worse(hold(model, {grip, encoder_m, delay_s, Ticking::gaps}, kFirm, 2.0));
          if (held(grip)) worst.keep_worse(hold(model, {grip, encoder_m, delay_s, Ticking::gaps}, kLight, 2.0));
        }
      }
    }
    say("at rest, force " + std::to_string(std::lround(1e3 * delay_s)) + " ms late",
        "%.2f encoder steps, %.2f JND peak to peak", worst.position_steps, worst.force_jnd);
    EXPECT_LE(worst.position_steps, kStill_steps) << delay_s;
    EXPECT_LE(worst.force_jnd, kStill_jnd) << delay_s;
  }
}

// Near its surface silicone has next to no viscosity, so that a mass that nothing
// holds, pushed with 0.3 N, would keep bouncing some millimetres high: the 450 N/m
// there, held and late, ask for 0.7 N s/m. With the controller the energy that one
// step of the encoder hides is left, 9 uJ at 0.3 N. Measured: 4.1 mm without, 1.0 mm
// with it; with 1.5 N s/m in the device it rests.
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

// ---- Energy ----

// Closed cycles within the block, the tool led along a sine of `amplitude_m`
// about `middle_m`: the damping that takes the same energy per cycle,
//   b = (put in - got out) / (pi w A^2),
// the least of 2 to 40 Hz. At or above 0: no energy comes out of any cycle.
double least_damping_Ns_per_m(const ForcePtr& model, double middle_m, double encoder_m, double amplitude_m,
                              Ticking ticking, bool passivity) {
  double least = std::numeric_limits<double>::infinity();
  for (const double rate_Hz : {2.0, 5.0, 10.0, 20.0, 40.0}) {
    LoopSettings settings{lead(), encoder_m, kOneTick_s, ticking};
    settings.passivity = passivity;
    ClosedLoop loop(settings);
    loop.publish(model);
    const double w = 2.0 * std::numbers::pi * rate_Hz;
    const auto sine = [&](double time_s) {
      return ClosedLoop::Drive{middle_m + amplitude_m * std::sin(w * time_s), amplitude_m * w * std::cos(w * time_s),
                               0.0};
    };
    loop.run(0.3, [&](double time_s) { return test::minimum_jerk(-2e-3, middle_m, 0.3, time_s); });
    loop.run(0.5, sine);
    const double before_J = loop.tool().energy().balance_J();
    loop.run(1.0, [&](double time_s) { return sine(time_s + 0.5); });
    const double per_cycle_J = (loop.tool().energy().balance_J() - before_J) / rate_Hz;
    least = std::min(least, per_cycle_J / (std::numbers::pi * w * amplitude_m * amplitude_m));
  }
  return least;
}

double least_damping_Ns_per_m(const ForcePtr& model, double middle_m, bool passivity = true) {
  double least = std::numeric_limits<double>::infinity();
  for (const double encoder_m : kEncoders_m) {
    for (const double amplitude_m : {1e-4, 5e-4}) {
      for (const Ticking ticking : {Ticking::even, Ticking::gaps}) {
        least = std::min(least, least_damping_Ns_per_m(model, middle_m, encoder_m, amplitude_m, ticking, passivity));
      }
    }
  }
  return least;
}

TEST(ClosedLoop, NoCycleInSiliconeGivesEnergy) {
  for (const ModelPtr& model : silicone_models()) {
    // By itself: nothing is left for the controller to do.
    const double least = least_damping_Ns_per_m(model, kFirm.depth_m, false);
    say("cycles, " + model->name(), "damping of %.2f N s/m or more, %.2f needed", least, 0.0);
    EXPECT_GE(least, 0.0) << model->name();
  }
  // What a spring does is known in closed form; at 40 Hz a tenth more.
  for (const double stiffness : {kSoftSpring_N_per_m, kStiffSpring_N_per_m}) {
    const double expected = held_and_late_Ns_per_m(stiffness);
    EXPECT_NEAR(least_damping_Ns_per_m(spring(stiffness), kFirmOnStiff.depth_m, 5e-6, 5e-4, Ticking::even, false),
                expected, -0.2 * expected);
  }
}

struct Strokes {
  double worst_return = 0.0;  // got out over put in, of single strokes
  double lowest_J = 0.0;      // of the balance at any time
  double largest_N = 0.0;
  double largest_cost_jnd = 0.0;  // of what the controller takes, over the JND
  double mean_cost_jnd = 0.0;     // in contact
};

// Four strokes from the air and back into it, in 0.1 to 0.8 s.
Strokes stroke(const ForcePtr& model, const LoopSettings& settings, const Press& press) {
  ClosedLoop loop(settings);
  loop.publish(model);
  const Grip& grip = settings.grip;
  Strokes strokes;
  double cost_sum = 0.0, contacts = 0.0;
  const auto watch = [&](const LoopSnapshot& snapshot) {
    strokes.lowest_J = std::min(strokes.lowest_J, loop.tool().energy().balance_J());
    strokes.largest_N = std::max(strokes.largest_N, snapshot.rendered_N);
    if (!snapshot.tick.in_contact) return;
    const double cost_jnd = (snapshot.commanded_N - snapshot.passive_N) / JndLine{}.at(snapshot.commanded_N);
    EXPECT_GE(cost_jnd, 0.0) << "it never adds force";
    strokes.largest_cost_jnd = std::max(strokes.largest_cost_jnd, cost_jnd);
    cost_sum += cost_jnd;
    ++contacts;
  };
  for (const double half_s : {0.05, 0.1, 0.2, 0.4}) {
    const LoopEnergy before = loop.tool().energy();
    if (held(grip)) {
      const double aim_m = press.depth_m + press.force_N / grip.stiffness_N_per_m;
      loop.run(half_s, [&](double time_s) { return test::minimum_jerk(-2e-3, aim_m, half_s, time_s); }, watch);
      loop.run(half_s + 0.3, [&](double time_s) { return test::minimum_jerk(aim_m, -2e-3, half_s, time_s); }, watch);
    } else {
      // Thrown from the air, and it flies away again.
      loop.tool().place(-1e-3, press.depth_m / half_s);
      loop.run(0.6, [](double) { return ClosedLoop::Drive{}; }, watch);
    }
    const LoopEnergy& after = loop.tool().energy();
    EXPECT_EQ(loop.tool().force_N(), 0.0) << grip.name << ": back in the air";
    strokes.worst_return = std::max(strokes.worst_return, (after.got_out_J - before.got_out_J) /
                                                              (after.put_in_J - before.put_in_J));
  }
  strokes.mean_cost_jnd = contacts > 0.0 ? cost_sum / contacts : 0.0;
  return strokes;
}

// An encoder turns a step late on the way in and a step late on the way out: at
// most that, over the largest force, may come out of a stroke for nothing.
// Silicone keeps a fifth of every stroke and needs none of it.
TEST(ClosedLoop, StrokesIntoSiliconeGiveLessThanTheyTake) {
  for (const ModelPtr& model : silicone_models()) {
    double worst_return = 0.0, worst_bounce = 0.0;
    for (const Grip& grip : test::grips()) {
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
    // Of a mass that is thrown at the surface and never gets to where silicone is
    // viscous one encoder step hides a part. Measured: 1.09; 1.19 without the controller.
    EXPECT_LE(worst_bounce, 1.15) << model->name();
  }
  for (const Grip& grip : test::grips()) {
    LoopSettings settings{grip, 5e-6, kOneTick_s, Ticking::even};
    settings.passivity = false;
    EXPECT_GT(stroke(spring(kSoftSpring_N_per_m), settings, kFirm).worst_return, 1.2) << grip.name;
  }
}

// What the controller takes of the force in a hand, in JNDs: nothing on silicone, which
// keeps a fifth of every stroke; on the stiff block what a held and late force gives
// back too much, on the way out. Measured: 0 and 0 JND; 0.67 JND on the mean of all
// ticks in contact, 13 JND in the fastest of them, out of the block within 50 ms.
TEST(ClosedLoop, TheControllerCostsAHandLessThanOneJnd) {
  const auto cost = [](const std::string& block, const std::vector<ModelPtr>& models, const Press& press) {
    Strokes worst;
    for (const ModelPtr& model : models) {
      for (const Grip& grip : test::grips()) {
        if (!held(grip)) continue;
        for (const double encoder_m : kEncoders_m) {
          const Strokes strokes = stroke(model, {grip, encoder_m, kOneTick_s, Ticking::gaps}, press);
          worst.mean_cost_jnd = std::max(worst.mean_cost_jnd, strokes.mean_cost_jnd);
          worst.largest_cost_jnd = std::max(worst.largest_cost_jnd, strokes.largest_cost_jnd);
        }
      }
    }
    say("passivity costs on " + block, "%.3f JND mean, %.2f JND at most", worst.mean_cost_jnd,
        worst.largest_cost_jnd);
    return worst;
  };
  EXPECT_LE(cost("silicone", silicone_models(), kFirm).largest_cost_jnd, 0.1);
  EXPECT_LE(cost("the stiff block", stiff_models(), kFirmOnStiff).mean_cost_jnd, 1.0);
}

// ---- Models exchanged while they are felt ----

ModelPtr with_huge_weights(const ModelPtr& model) {
  ModelData data = model->data();
  test::change_rbf(data, [](RbfFunction& f) {
    for (Eigen::Index i = 0; i < f.weights.size(); ++i) f.weights[i] = i % 2 == 0 ? 1e300 : -1e300;
  });
  return std::make_shared<const FittedModel>(std::move(data));
}

long sets_alive(const std::vector<ForcePtr>& models, const std::vector<long>& own) {
  long alive = 0;
  for (std::size_t i = 0; i < models.size(); ++i) alive += models[i].use_count() - own[i];
  return alive;
}

// Presses for a second, then a new set every 10 ms for two seconds. The largest
// change of the rendered force within 10 ms, over the JND of the smaller force.
double largest_change_jnd(const std::vector<ForcePtr>& models, const Grip& grip, double encoder_m) {
  std::vector<long> own;
  for (const ForcePtr& model : models) own.push_back(model.use_count());
  double largest = 0.0;
  {
    ClosedLoop loop({grip, encoder_m, kOneTick_s, Ticking::gaps});
    loop.publish(models.front());
    std::vector<double> time_s, force_N;
    std::size_t published = 0;
    const double aim_m = kFirm.depth_m + kFirm.force_N / grip.stiffness_N_per_m;
    loop.run(3.0, [&](double time) { return test::minimum_jerk(-2e-3, aim_m, 0.3, time); },
             [&](const LoopSnapshot& snapshot) {
               EXPECT_TRUE(std::isfinite(snapshot.commanded_N) && std::isfinite(snapshot.rendered_N));
               time_s.push_back(snapshot.loop_time_s);
               force_N.push_back(snapshot.rendered_N);
               if (time_s.back() < 1.0) return;
               for (std::size_t i = time_s.size(); i-- > 0 && time_s.back() - time_s[i] < 0.01 + 1e-9;) {
                 const double jnd_N = JndLine{}.at(std::min(force_N[i], force_N.back()));
                 largest = std::max(largest, std::abs(force_N.back() - force_N[i]) / jnd_N);
               }
               if (time_s.back() < 1.0 + 0.01 * static_cast<double>(published)) return;
               loop.publish(models[++published % models.size()]);
               // In the hand, fading out, pending, retired since.
               EXPECT_LE(sets_alive(models, own), 4);
             });
    EXPECT_GE(published, 190u);
    EXPECT_EQ(loop.faults() & loop_fault::kStops, 0u);
    if (test::rt_guard_works()) {
      EXPECT_EQ(loop.offences(), 0);
    }
    loop.slot().collect();
    EXPECT_LE(sets_alive(models, own), 3);
  }
  EXPECT_EQ(sets_alive(models, own), 0) << "not all of them were collected";
  return largest;
}

TEST(ClosedLoop, AHundredExchangesASecondAreNotFelt) {
  const std::vector<ForcePtr> methods(silicone_models().begin(), silicone_models().end());
  std::vector<ForcePtr> with_broken = methods;
  with_broken.push_back(with_huge_weights(silicone_models().back()));
  std::vector<ForcePtr> with_foreign = methods;
  with_foreign.push_back(spring(0.5 * kSoftSpring_N_per_m));
  struct Exchange {
    std::string name;
    std::vector<ForcePtr> models;
    double in_hand_jnd;
  };
  // A model half as stiff makes the hand move a millimetre and back all the time,
  // and what the models say of that motion passes through unhindered: 1.24 JND.
  const Exchange exchanges[] = {
      {"methods", methods, 1.0}, {"weights of 1e300", with_broken, 1.0}, {"half as stiff", with_foreign, 1.4}};
  for (const Exchange& exchange : exchanges) {
    for (const double encoder_m : kEncoders_m) {
      const double led = largest_change_jnd(exchange.models, lead(), encoder_m);
      const double in_hand = largest_change_jnd(exchange.models, test::grips()[1], encoder_m);
      say("exchanges, " + exchange.name, "%.2f JND in 10 ms with the tool led, %.2f JND in a hand", led, in_hand);
      EXPECT_LE(led, 1.0) << exchange.name;
      EXPECT_LE(in_hand, exchange.in_hand_jnd) << exchange.name;
    }
  }
}

// ---- The hard case for stability ----

// Falls short, visibly: one step of 30 um is 0.35 JND on 3 kN/m, and a relaxed
// hand has less damping than the 4.5 N s/m that the block asks for, so that it
// feels a buzz of 2 JND with such an encoder. Measured: 3.9 steps, 2.0 JND; with
// a 5 um encoder 0.3 JND.
constexpr double kStiffStill_steps = 6.0;
constexpr double kStiffStill_jnd = 3.0;
constexpr double kFineStill_jnd = 0.5;

TEST(ClosedLoop, TheStiffBlockIsStableInAHand) {
  for (const ModelPtr& model : stiff_models()) {
    Rest worst, fine;
    for (const Grip& grip : test::grips()) {
      if (!held(grip)) continue;
      worst.keep_worse(worst_hold(model, grip, kFirmOnStiff, 3.0));
      fine.keep_worse(hold(model, {grip, 5e-6, kOneTick_s, Ticking::gaps}, kFirmOnStiff, 3.0));
    }
    const double least = least_damping_Ns_per_m(model, kFirmOnStiff.depth_m);
    say("stiff, at rest, " + model->name(), "%.2f encoder steps, %.2f JND peak to peak", worst.position_steps,
        worst.force_jnd);
    say("stiff, " + model->name(), "with 5 um %.2f JND; cycles %.2f N s/m", fine.force_jnd, least);
    EXPECT_LE(worst.position_steps, kStiffStill_steps) << model->name();
    EXPECT_LE(worst.force_jnd, kStiffStill_jnd) << model->name();
    EXPECT_LE(fine.force_jnd, kFineStill_jnd) << model->name();
    EXPECT_GE(least, held_and_late_Ns_per_m(kStiffSpring_N_per_m)) << model->name() << ": its own viscosity helps";
  }
  // What the model's viscosity is worth: a spring as stiff goes on for ever.
  EXPECT_GT(worst_hold(spring(kStiffSpring_N_per_m), test::grips()[0], kFirmOnStiff, 3.0, false).force_jnd, 10.0);
}

// A mass that nothing holds takes energy from the held and late force of the stiff
// block and would be thrown about. The controller brings it to a buzz of some encoder
// steps, 6 N s/m in the device to rest. Measured: 137 mm without the controller, 0.2 mm
// with it.
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

}  // namespace
}  // namespace palpate
