#include "tests/support/scripted_press.h"

#include <cmath>
#include <memory>
#include <stdexcept>

#include "engine/base/random_stream.h"
#include "scenes/material/material.h"

namespace palpate::test {
namespace {

constexpr double kStart_m = -0.002;
constexpr double kStep_s = 0.001;  // Block divides it into smaller steps
constexpr double kForceNoise_N = 0.005;
// Peak speed of a minimum-jerk path of length 1 in time 1.
constexpr double kPeakSpeed = 1.875;

}  // namespace

ScriptedPress scripted_press(const std::string& material, const std::vector<Stretch>& script, double encoder_step_m,
                             std::uint64_t seed) {
  const auto found = find_material(material);
  if (!found) throw std::runtime_error(found.error().message);
  const std::unique_ptr<Block> block = found->make_block();
  block->reset(kStart_m);
  RandomStream noise(seed, 0);
  ScriptedPress press;
  press.recording.name = material + "_scripted";
  double from_m = kStart_m;
  for (const Stretch& stretch : script) {
    const auto steps = static_cast<int>(std::ceil(stretch.duration_s / kStep_s));
    const double length_m = stretch.target_m - from_m;
    for (int i = 1; i <= steps; ++i) {
      const double u = static_cast<double>(i) / steps;
      const double position_m = from_m + length_m * u * u * u * (10.0 - u * (15.0 - 6.0 * u));
      const double velocity_m_per_s = length_m * 30.0 * u * u * (1.0 - u) * (1.0 - u) / (steps * kStep_s);
      const double force_N = block->step(position_m, velocity_m_per_s, kStep_s);
      RecordingRow row;
      row.time_s = kStep_s * static_cast<double>(press.recording.rows.size());
      row.position_m = encoder_step_m > 0.0 ? encoder_step_m * std::round(position_m / encoder_step_m) : position_m;
      row.force_N = force_N + kForceNoise_N * noise.normal();
      press.recording.rows.push_back(row);
      press.true_N.push_back(force_N);
    }
    from_m = stretch.target_m;
  }
  return press;
}

std::vector<Stretch> press_and_hold(double depth_m, double speed_m_per_s, double hold_s) {
  const double travel_s = kPeakSpeed * (depth_m - kStart_m) / speed_m_per_s;
  return {{depth_m, travel_s}, {depth_m, hold_s}, {kStart_m, travel_s}, {kStart_m, 0.5}};
}

}  // namespace palpate::test
