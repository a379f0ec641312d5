#include "tests/support/closed_loop_energy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <numbers>

namespace palpate::test {

double held_and_late_Ns_per_m(double stiffness_N_per_m) { return -stiffness_N_per_m * (0.5 * kOneTick_s + kOneTick_s); }

void say(const std::string& who, const char* format, double first, double second) {
  char figures[120];
  std::snprintf(figures, sizeof figures, format, first, second);
  std::cout << who << ": " << figures << '\n';
}

Grip lead() { return {"lead", 1.0, 4e5, 1200.0}; }

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
    loop.run(0.3, [&](double time_s) { return minimum_jerk(-2e-3, middle_m, 0.3, time_s); });
    loop.run(0.5, sine);
    const double before_J = loop.tool().energy().balance_J();
    loop.run(1.0, [&](double time_s) { return sine(time_s + 0.5); });
    const double per_cycle_J = (loop.tool().energy().balance_J() - before_J) / rate_Hz;
    least = std::min(least, per_cycle_J / (std::numbers::pi * w * amplitude_m * amplitude_m));
  }
  return least;
}

double least_damping_Ns_per_m(const ForcePtr& model, double middle_m, bool passivity) {
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
      loop.run(
          half_s, [&](double time_s) { return minimum_jerk(-2e-3, aim_m, half_s, time_s); }, watch);
      loop.run(
          half_s + 0.3, [&](double time_s) { return minimum_jerk(aim_m, -2e-3, half_s, time_s); }, watch);
    } else {
      // The mass is thrown at the block from the air and bounces off.
      loop.tool().place(-1e-3, press.depth_m / half_s);
      loop.run(
          0.6, [](double) { return ClosedLoop::Drive{}; }, watch);
    }
    const LoopEnergy& after = loop.tool().energy();
    EXPECT_EQ(loop.tool().force_N(), 0.0) << grip.name << ": back in the air";
    strokes.worst_return =
        std::max(strokes.worst_return, (after.got_out_J - before.got_out_J) / (after.put_in_J - before.put_in_J));
  }
  strokes.mean_cost_jnd = contacts > 0.0 ? cost_sum / contacts : 0.0;
  return strokes;
}

}  // namespace palpate::test
