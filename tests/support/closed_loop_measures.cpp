#include "tests/support/closed_loop_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numbers>

#include "engine/base/random_stream.h"

namespace palpate::test {
namespace {

// A force that the blocks of these tests support at full stiffness.
constexpr double kFirm_N = 3.0;

// Peak to peak after subtracting a straight line, because creep during a hold is
// not an oscillation.
double ripple(const std::vector<double>& values) {
  const auto n = static_cast<Eigen::Index>(values.size());
  const Eigen::Map<const Eigen::ArrayXd> value(values.data(), n);
  const auto half = 0.5 * static_cast<double>(n - 1);
  const Eigen::ArrayXd time = Eigen::ArrayXd::LinSpaced(n, -half, half);
  const Eigen::ArrayXd rest = value - (value * time).sum() / time.square().sum() * time;
  return rest.maxCoeff() - rest.minCoeff();
}

}  // namespace

std::function<std::int64_t(std::int64_t& deadline)> ticks(Ticking ticking) {
  if (ticking == Ticking::even) return {};
  return [ticking, random = RandomStream(1, 77)](std::int64_t& deadline) mutable {
    constexpr std::int64_t kGapEvery = 100 * kPeriodSteps;
    if (ticking == Ticking::gaps) {
      if (random.index(30) == 0) deadline += kPeriodSteps;
      if (deadline / kGapEvery != (deadline - kPeriodSteps) / kGapEvery) deadline += 4 * kPeriodSteps;
    }
    return deadline + static_cast<std::int64_t>(random.index(10));
  };
}

const std::vector<ModelPtr>& loop_models(const std::string& material) {
  static std::map<std::string, std::vector<ModelPtr>> fitted;
  std::vector<ModelPtr>& models = fitted[material];
  if (!models.empty()) return models;
  const bool simple = material == "maxwell" || material == "stiff";
  RigSettings settings = train_settings(material);
  settings.seconds = simple ? 10.0 : 12.0;
  settings.rate_Hz = 250.0;  // keeps direct fits short
  const PreparedTraining prepared =
      prepare({rig_recording(settings)}, simple ? scene_request(material == "stiff" ? "stiff_block" : "silicone_block")
                                                : default_request("silicone_block"));
  if (simple) return models = fit_all(prepared);
  for (const char* method : {"trend", "direct", "voxel", "greedy"}) {
    models.push_back(fit(prepared, parse_plan(method)->method));
  }
  return models;
}

HandPress half_press(const ModelPtr& model) {
  return {0.4 * model->data().largest_force_N, 0.6 * model->data().trend.reference_depth_m};
}

double held_and_late_Ns_per_m(double stiffness_N_per_m) { return -stiffness_N_per_m * (0.5 * kOneTick_s + kOneTick_s); }

void Rest::keep_worse(const Rest& other) {
  span_m = std::max(span_m, other.span_m);
  position_m = std::max(position_m, other.position_m);
  position_steps = std::max(position_steps, other.position_steps);
  force_jnd = std::max(force_jnd, other.force_jnd);
  given_J = std::max(given_J, other.given_J);
  largest_N = std::max(largest_N, other.largest_N);
  share = std::min(share, other.share);
}

Rest hold(const ForcePtr& model, const ClosedLoopSettings& settings, const HandPress& press, double seconds,
          double still_s) {
  GuardedLoop loop(settings);
  loop.publish(model);
  const Grip& grip = settings.grip;
  Rest rest;
  const auto path = [&](double time_s) {
    ClosedLoop::Drive drive;
    if (held(grip)) {
      drive = minimum_jerk(-2e-3, press.depth_m + press.force_N / grip.stiffness_N_per_m, 0.3, time_s);
    } else {
      drive.push_N = minimum_jerk(0.0, std::min(press.force_N, rest.share * kFirm_N), 0.3, time_s).aim_m;
    }
    if (time_s >= 0.6 && time_s < 0.62) drive.push_N += 1.0;
    return drive;
  };
  double before_J = 0.0;
  std::vector<double> position_m, force_N;
  loop.run(seconds, path, [&](const LoopSnapshot& snapshot) {
    EXPECT_TRUE(std::isfinite(snapshot.rendered_N));
    rest.share = static_cast<double>(snapshot.stiffness_share);
    rest.largest_N = std::max(rest.largest_N, snapshot.rendered_N);
    if (snapshot.loop_time_s < seconds - still_s) {
      before_J = loop.tool().energy().balance_J();
      return;
    }
    position_m.push_back(loop.tool().position_m());
    force_N.push_back(snapshot.rendered_N);
  });
  EXPECT_EQ(loop.faults() & loop_fault::kStops, 0u);
  EXPECT_EQ(loop.offences(), 0);
  const auto [lowest_m, highest_m] = std::minmax_element(position_m.begin(), position_m.end());
  rest.span_m = *highest_m - *lowest_m;
  rest.position_m = ripple(position_m);
  rest.position_steps = rest.position_m / settings.encoder_step_m;
  rest.force_jnd = ripple(force_N) / JndLine{}.at(press.force_N);
  rest.given_J = before_J - loop.tool().energy().balance_J();
  return rest;
}

Rest worst_hold(const ForcePtr& model, const Grip& grip, const HandPress& press, double seconds) {
  Rest worst;
  for (const double encoder_m : kEncoders_m) {
    for (const Ticking ticking : kTickings) {
      ClosedLoopSettings settings{grip, encoder_m, kOneTick_s, ticks(ticking)};
      worst.keep_worse(hold(model, settings, press, seconds));
    }
  }
  return worst;
}

double least_damping_Ns_per_m(const ForcePtr& model, double middle_m, double encoder_m, double amplitude_m,
                              Ticking ticking) {
  double least = std::numeric_limits<double>::infinity();
  for (const double rate_Hz : {2.0, 5.0, 10.0, 20.0, 40.0}) {
    ClosedLoopSettings settings{lead(), encoder_m, kOneTick_s, ticks(ticking)};
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

double least_damping_Ns_per_m(const ForcePtr& model, double middle_m) {
  double least = std::numeric_limits<double>::infinity();
  for (const double encoder_m : kEncoders_m) {
    for (const double amplitude_m : {1e-4, 5e-4}) {
      for (const Ticking ticking : {Ticking::even, Ticking::gaps}) {
        least = std::min(least, least_damping_Ns_per_m(model, middle_m, encoder_m, amplitude_m, ticking));
      }
    }
  }
  return least;
}

void Strokes::keep_worse(const Strokes& other) {
  worst_return = std::max(worst_return, other.worst_return);
  beyond_step_J = std::max(beyond_step_J, other.beyond_step_J);
  own_beyond_step_J = std::max(own_beyond_step_J, other.own_beyond_step_J);
  largest_cost_jnd = std::max(largest_cost_jnd, other.largest_cost_jnd);
  mean_cost_jnd = std::max(mean_cost_jnd, other.mean_cost_jnd);
}

Strokes stroke(const ForcePtr& model, const ClosedLoopSettings& settings, const HandPress& press) {
  ClosedLoop loop(settings);
  loop.publish(model);
  const Grip& grip = settings.grip;
  Strokes strokes;
  double cost_sum = 0.0, contacts = 0.0, lowest_J = 0.0, largest_N = 0.0, own_largest_N = 0.0;
  const auto watch = [&](const LoopSnapshot& snapshot) {
    lowest_J = std::min(lowest_J, loop.tool().energy().balance_J());
    largest_N = std::max(largest_N, snapshot.rendered_N);
    own_largest_N = std::max(own_largest_N, snapshot.rendered_N);
    if (!snapshot.tick.in_contact) return;
    const double cost_jnd = (snapshot.commanded_N - snapshot.passive_N) / JndLine{}.at(snapshot.commanded_N);
    EXPECT_GE(cost_jnd, 0.0) << "it never adds force";
    strokes.largest_cost_jnd = std::max(strokes.largest_cost_jnd, cost_jnd);
    cost_sum += cost_jnd;
    ++contacts;
  };
  for (const double half_s : {0.05, 0.1, 0.2, 0.4}) {
    const LoopEnergy before = loop.tool().energy();
    own_largest_N = 0.0;
    const auto move = [&](double from_m, double to_m, double seconds) {
      loop.run(
          seconds, [&](double time_s) { return minimum_jerk(from_m, to_m, half_s, time_s); }, watch);
    };
    if (held(grip)) {
      const double aim_m = press.depth_m + press.force_N / grip.stiffness_N_per_m;
      move(-2e-3, aim_m, half_s);
      move(aim_m, -2e-3, half_s + 0.3);
    } else {
      // The mass is carried back, because no hand jumps, thrown at the block and bounces off. The aim of a mass alone
      // has no effect.
      const double from_m = loop.tool().position_m();
      loop.run(0.3, [&](double time_s) {
        const ClosedLoop::Drive carried = minimum_jerk(from_m, -1e-3, 0.2, time_s);
        loop.tool().place(carried.aim_m, carried.aim_m_per_s);
        return ClosedLoop::Drive{};
      });
      loop.tool().place(-1e-3, press.depth_m / half_s);
      move(0.0, 0.0, 0.6);
    }
    const LoopEnergy& after = loop.tool().energy();
    EXPECT_EQ(loop.tool().force_N(), 0.0) << grip.name << ": back in the air";
    const double in_J = after.put_in_J - before.put_in_J, out_J = after.got_out_J - before.got_out_J;
    strokes.worst_return = std::max(strokes.worst_return, out_J / in_J);
    strokes.own_beyond_step_J =
        std::max(strokes.own_beyond_step_J, out_J - in_J - settings.encoder_step_m * own_largest_N);
  }
  strokes.beyond_step_J = -lowest_J - settings.encoder_step_m * largest_N;
  strokes.mean_cost_jnd = contacts > 0.0 ? cost_sum / contacts : 0.0;
  return strokes;
}

void say(const std::string& who, const char* format, double first, double second) {
  std::printf("%s: ", who.c_str());
  std::printf(format, first, second);
  std::printf("\n");
}

}  // namespace palpate::test
