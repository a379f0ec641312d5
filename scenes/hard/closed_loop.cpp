#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "scenes/hard/hard.h"

namespace palpate {

constexpr double kStepsPerSecond = 1000.0 * static_cast<double>(kPeriodSteps);
constexpr double kStep_s = 1.0 / kStepsPerSecond;

static std::int64_t steps_in(double seconds) { return std::llround(seconds * kStepsPerSecond); }

double SimulatedTool::time_s() const noexcept { return kStep_s * static_cast<double>(step_); }

bool SimulatedTool::read(double now_s, DeviceSample& sample) noexcept {
  if (read_step_ == step_) return false;
  read_step_ = step_;
  // If samples are more frequent than ticks, this is the newest one.
  if (step_ < sample_step_) return false;
  const int waits = ++sample_ % settings_.grouped == 0 ? settings_.grouped : 1;
  sample_step_ = step_ + waits * steps_in(settings_.sample_s) - (settings_.sample_s > 1e-3 ? kPeriodSteps / 2 : 0);
  if (settings_.lost_in > 0 && random_.index(settings_.lost_in) == 0) return false;
  sample = {};
  sample.tool.time_s = now_s;
  const double quantum_m = settings_.encoder_step_m;
  sample.tool.position_m = quantum_m > 0.0 ? quantum_m * std::round(position_m_ / quantum_m) : position_m_;
  sample.force_age = {kStep_s * static_cast<double>(step_ - acting_.sampled),
                      kStep_s * static_cast<double>(step_ - std::exchange(acted_from_, acting_.sampled))};
  newest_sample_ = step_;
  return true;
}

DeviceHealth SimulatedTool::health(double) noexcept {
  DeviceHealth health;
  health.sample_age_s = 0.0;
  health.interval_s = settings_.sample_s;
  return health;
}

void SimulatedTool::write(double force_N) noexcept {
  if (count_ == written_.size()) return;  // a delay of 10 ms fills less than half
  if (settings_.lost_in > 0 && random_.index(settings_.lost_in) == 0) return;
  const double jitter_s = settings_.jitter_s > 0.0 ? random_.uniform(0.0, settings_.jitter_s) : 0.0;
  std::int64_t due = step_ + steps_in(settings_.delay_s + jitter_s);
  if (count_ > 0) due = std::max(due, written_[(first_ + count_ - 1) % written_.size()].due);
  written_[(first_ + count_++) % written_.size()] = {force_N, newest_sample_, due};
}

// Acceleration is constant within a step, so that the work of the held force is exact
// and the integration adds no energy to a free mass.
void SimulatedTool::advance(double aim_m, double aim_m_per_s, double push_N) noexcept {
  while (count_ > 0 && written_[first_].due <= step_) {
    acting_ = written_[first_];
    first_ = (first_ + 1) % written_.size();
    --count_;
  }
  const Grip& grip = settings_.grip;
  const double drive_N = grip.stiffness_N_per_m * (aim_m - position_m_) +
                         grip.damping_Ns_per_m * (aim_m_per_s - velocity_m_per_s_) + push_N;
  const double before_m_per_s = velocity_m_per_s_;
  velocity_m_per_s_ += kStep_s * (drive_N - acting_.force_N) / grip.mass_kg;
  const double way_m = 0.5 * kStep_s * (before_m_per_s + velocity_m_per_s_);
  position_m_ += way_m;
  const double work_J = acting_.force_N * way_m;
  (work_J > 0.0 ? energy_.put_in_J : energy_.got_out_J) += std::abs(work_J);
  ++step_;
}

void SimulatedTool::place(double position_m, double velocity_m_per_s) noexcept {
  position_m_ = position_m;
  velocity_m_per_s_ = velocity_m_per_s;
}

ClosedLoop::ClosedLoop(const ClosedLoopSettings& settings)
    : tool_(settings), live_(tool_, slot_), uneven_(settings.uneven) {
  controls_.scale = settings.scale;
}

void ClosedLoop::publish(std::shared_ptr<const ForceModel> model) {
  auto set = std::make_unique<LiveModels>(++id_, tool_.sensor(), std::vector{std::move(model)});
  set->tick.recall(history_);
  slot_.publish(std::move(set));
}

void ClosedLoop::run(double seconds, const Path& path, const AfterTick& after_tick) {
  const std::int64_t from = step_;
  const std::int64_t end = step_ + steps_in(seconds);
  for (; step_ < end; ++step_) {
    if (step_ == due_) {
      const LoopSnapshot& snapshot = tick();
      faults_ |= snapshot.faults;
      if (snapshot.samples > 0) history_.add(snapshot.tick, snapshot.restarted);
      deadline_ += kPeriodSteps;
      due_ = uneven_ ? uneven_(deadline_) : deadline_;
      if (after_tick) after_tick(snapshot);
    }
    const Drive drive = path(kStep_s * static_cast<double>(step_ - from));
    tool_.advance(drive.aim_m, drive.aim_m_per_s, drive.push_N);
  }
}

ClosedLoop::Drive minimum_jerk(double from_m, double to_m, double duration_s, double time_s) {
  const double u = std::clamp(time_s / duration_s, 0.0, 1.0);
  const double way_m = to_m - from_m;
  return {from_m + way_m * u * u * u * (10.0 + u * (6.0 * u - 15.0)),
          way_m * 30.0 * u * u * (1.0 - u) * (1.0 - u) / duration_s, 0.0};
}

}  // namespace palpate
