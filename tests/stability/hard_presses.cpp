#include "tests/stability/hard_presses.h"

#include <algorithm>
#include <cmath>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

constexpr double kStep_s = 50e-6;
constexpr double kStiffness_N_per_m = 300.0;
constexpr double kStiffening_N_per_m2 = 2e4;
constexpr double kDamping_Ns_per_m = 2.0;
constexpr double kBranchStiffness_N_per_m = 100.0;
constexpr double kRelaxationTime_s = 0.17;

// Moves the state of the material along a path.
class PressedBlock {
 public:
  explicit PressedBlock(const Path& path) : path_(path), position_m_(path(0.0)) {}

  double force_at(double time_s) {
    // Equal steps, because a tiny last step would give a wrong velocity.
    const double steps = std::ceil((time_s - time_s_) / kStep_s - 1e-6);
    const double from_s = time_s_;
    for (double i = 1.0; i <= steps; ++i) advance(from_s + (time_s - from_s) * i / steps);
    const double depth_m = std::max(0.0, position_m_);
    if (depth_m == 0.0) return 0.0;
    return std::max(0.0, kStiffness_N_per_m * depth_m + kStiffening_N_per_m2 * depth_m * depth_m +
                             kDamping_Ns_per_m * velocity_m_per_s_ + branch_N_);
  }
  double position_m() const { return position_m_; }

 private:
  void advance(double to_s) {
    const double step_s = to_s - time_s_;
    const double next_m = path_(to_s);
    const double keep = std::exp(-step_s / kRelaxationTime_s);
    const double rate = (std::max(0.0, next_m) - std::max(0.0, position_m_)) / step_s;
    branch_N_ = keep * branch_N_ + kBranchStiffness_N_per_m * kRelaxationTime_s * (1.0 - keep) * rate;
    velocity_m_per_s_ = (next_m - position_m_) / step_s;
    position_m_ = next_m;
    time_s_ = to_s;
  }

  const Path& path_;
  double time_s_ = 0.0;
  double position_m_ = 0.0;
  double velocity_m_per_s_ = 0.0;
  double branch_N_ = 0.0;
};

}  // namespace

Press press_along(const Path& path, const std::vector<double>& times_s, const PressSensors& sensors) {
  RandomStream noise(1, 0);
  PressedBlock block(path);
  Press press;
  press.recording.name = "press";
  for (const double time_s : times_s) {
    const double force_N = block.force_at(time_s);
    double position_m = block.position_m();
    if (sensors.encoder_step_m > 0.0)
      position_m = sensors.encoder_step_m * std::round(position_m / sensors.encoder_step_m);
    press.true_N.push_back(force_N);
    press.recording.rows.push_back({time_s, position_m, force_N + sensors.force_noise_N * noise.normal(), 0.0, 0.0});
  }
  return press;
}

Press press_into(Block& block, const Path& path, const std::vector<double>& times_s) {
  Press press;
  press.recording.name = "press";
  double last_s = times_s.empty() ? 0.0 : times_s.front();
  block.reset(path(last_s));
  for (const double time_s : times_s) {
    const double position_m = path(time_s);
    const double velocity_m_per_s = (path(time_s + kStep_s) - path(time_s - kStep_s)) / (2.0 * kStep_s);
    const double force_N = time_s > last_s ? block.step(position_m, velocity_m_per_s, time_s - last_s) : 0.0;
    press.true_N.push_back(force_N);
    press.recording.rows.push_back({time_s, position_m, force_N, 0.0, 0.0});
    last_s = time_s;
  }
  return press;
}

Press clean_training() { return press_along(training_path(0), even_times(kTrainingSeconds, kTrainingRate_Hz)); }

Path scaled(const Path& path, double factor, double offset_m) {
  return [=](double time_s) { return offset_m + factor * path(time_s); };
}

std::vector<double> even_times(double seconds, double rate_Hz) {
  std::vector<double> times_s;
  for (double i = 0.0; i < seconds * rate_Hz; ++i) times_s.push_back(i / rate_Hz);
  return times_s;
}

Path training_path(int variant) {
  return [variant](double time_s) {
    // Two tones whose sum does not repeat within a minute, compressed so that the
    // tool pauses at the turning points.
    const double pace = variant == 0 ? 1.0 : 0.93;
    const double slow = std::sin(2.0 * M_PI * 0.41 * pace * time_s + 0.4 * variant);
    const double fast = std::sin(2.0 * M_PI * 1.37 * pace * time_s);
    return 0.0025 + 0.0035 * std::tanh(1.4 * (0.75 * slow + 0.45 * fast));
  };
}

}  // namespace palpate
