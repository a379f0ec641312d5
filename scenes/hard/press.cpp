#include "scenes/hard/press.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

// Half the span of a central difference of a path.
constexpr double kHalfSpan_s = 50e-6;
// Peak speed of a minimum-jerk path of length 1 in time 1.
constexpr double kPeakSpeed = 1.875;

}  // namespace

Path along(std::vector<Stretch> stretches) {
  return [stretches = std::move(stretches)](double time_s) {
    double from_m = kInAir_m;
    for (const auto& [target_m, duration_s] : stretches) {
      if (time_s < duration_s) {
        const double u = std::max(0.0, time_s / duration_s);
        return from_m + (target_m - from_m) * u * u * u * (10.0 - u * (15.0 - 6.0 * u));
      }
      time_s -= duration_s;
      from_m = target_m;
    }
    return from_m;
  };
}

std::vector<Stretch> press_and_hold(double depth_m, double speed_m_per_s, double hold_s) {
  const double travel_s = kPeakSpeed * (depth_m - kInAir_m) / speed_m_per_s;
  return {{depth_m, travel_s}, {depth_m, hold_s}, {kInAir_m, travel_s}, {kInAir_m, 0.5}};
}

std::vector<double> even_times(double seconds, double rate_Hz) {
  std::vector<double> times_s;
  for (double i = 0.0; i < seconds * rate_Hz; ++i) times_s.push_back(i / rate_Hz);
  return times_s;
}

Press press_into(Block& block, const Path& path, const std::vector<double>& times_s, const PressSensors& sensors) {
  RandomStream noise(sensors.seed, 0);
  Press press;
  press.recording.name = "press";
  double last_s = times_s.front() - kHalfSpan_s;
  block.reset(path(last_s));
  for (const double time_s : times_s) {
    double position_m = path(time_s);
    const double velocity_m_per_s = (path(time_s + kHalfSpan_s) - path(time_s - kHalfSpan_s)) / (2.0 * kHalfSpan_s);
    const double force_N = block.step(position_m, velocity_m_per_s, time_s - last_s);
    if (sensors.encoder_step_m > 0.0)
      position_m = sensors.encoder_step_m * std::round(position_m / sensors.encoder_step_m);
    press.true_N.push_back(force_N);
    press.recording.rows.push_back({time_s, position_m, force_N + sensors.force_noise_N * noise.normal(), 0.0, 0.0});
    last_s = time_s;
  }
  return press;
}

}  // namespace palpate
