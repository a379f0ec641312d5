#include "tests/support/closed_loop_rest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace palpate::test {
namespace {

// A force that the blocks of these tests support at full stiffness.
constexpr double kFirm_N = 3.0;

// 250 Hz keeps direct fits short.
std::vector<ModelPtr> fitted(const std::string& material) {
  RigSettings settings = train_settings(material);
  settings.seconds = 10.0;
  settings.rate_Hz = 250.0;
  return fit_all(prepare({rig_recording(settings)},
                         scene_request(material == "maxwell" ? "silicone_block" : material + "_block")));
}

// Peak to peak after subtracting a straight line, because creep during a hold is
// not an oscillation.
double ripple(const std::vector<double>& values) {
  const double middle = 0.5 * static_cast<double>(values.size() - 1);
  double sum = 0.0, along = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double t = static_cast<double>(i) - middle;
    sum += values[i];
    along += t * values[i];
    squares += t * t;
  }
  Span span;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double t = static_cast<double>(i) - middle;
    span.add(values[i] - sum / static_cast<double>(values.size()) - along / squares * t);
  }
  return span.width();
}

}  // namespace

const std::vector<ModelPtr>& silicone_models() {
  // Springs and dashpots, which come to rest within seconds. The default silicone creeps
  // for minutes.
  static const std::vector<ModelPtr> models = fitted("maxwell");
  return models;
}

const std::vector<ModelPtr>& stiff_models() {
  static const std::vector<ModelPtr> models = fitted("stiff");
  return models;
}

Rest hold(const ForcePtr& model, const LoopSettings& settings, const Press& press, double seconds) {
  ClosedLoop loop(settings);
  loop.publish(model);
  const Grip& grip = settings.grip;
  double share = 1.0;  // rendered share of the stiffness; limits the push on a free mass
  const auto path = [&](double time_s) {
    ClosedLoop::Drive drive;
    if (held(grip)) {
      drive = minimum_jerk(-2e-3, press.depth_m + press.force_N / grip.stiffness_N_per_m, 0.3, time_s);
    } else {
      drive.push_N = minimum_jerk(0.0, std::min(press.force_N, share * kFirm_N), 0.3, time_s).aim_m;
    }
    if (time_s >= 0.6 && time_s < 0.62) drive.push_N += 1.0;
    return drive;
  };
  Rest rest;
  std::vector<double> position_m, force_N;
  loop.run(seconds, path, [&](const LoopSnapshot& snapshot) {
    EXPECT_TRUE(std::isfinite(snapshot.rendered_N));
    share = static_cast<double>(snapshot.stiffness_share);
    rest.largest_N = std::max(rest.largest_N, snapshot.rendered_N);
    if (snapshot.loop_time_s < seconds - 0.25) return;
    position_m.push_back(loop.tool().position_m());
    force_N.push_back(snapshot.rendered_N);
  });
  EXPECT_EQ(loop.faults() & loop_fault::kStops, 0u);
  rest.position_m = ripple(position_m);
  rest.position_steps = rest.position_m / settings.encoder_step_m;
  rest.force_jnd = ripple(force_N) / JndLine{}.at(press.force_N);
  return rest;
}

Rest worst_hold(const ForcePtr& model, const Grip& grip, const Press& press, double seconds, bool passivity) {
  Rest worst;
  for (const double encoder_m : kEncoders_m) {
    for (const Ticking ticking : {Ticking::even, Ticking::jittered, Ticking::gaps}) {
      LoopSettings settings{grip, encoder_m, kOneTick_s, ticking};
      settings.passivity = passivity;
      worst.keep_worse(hold(model, settings, press, seconds));
    }
  }
  return worst;
}

}  // namespace palpate::test
