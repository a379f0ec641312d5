#include "engine/live/force_guard.h"

namespace palpate {
namespace {

// The time constant with which the reduction decays while models are exchanged.
constexpr double kLetGo_s = 0.01;

}  // namespace

void PassivityController::begin_at(double depth_m) noexcept {
  passed_[0] = {depth_m, 0.0};
  count_ = 1;
  energy_J_ = debt_J_ = 0.0;
  depth_m_ = depth_m;
}

void PassivityController::pass_inwards(double depth_m, double energy_J) noexcept {
  if (count_ < kMostPassed) ++count_;  // otherwise the deepest is replaced
  passed_[count_ - 1] = {depth_m, energy_J};
}

// Interpolates between the passed depths; deeper ones are passed during unloading now and removed.
double PassivityController::energy_when_passed(double depth_m) noexcept {
  while (count_ > 1 && passed_[count_ - 2].depth_m >= depth_m) --count_;
  Passed& deeper = passed_[count_ - 1];
  if (count_ > 1 && deeper.depth_m > depth_m) {
    const Passed& below = passed_[count_ - 2];
    const double share = (depth_m - below.depth_m) / (deeper.depth_m - below.depth_m);
    deeper = {depth_m, below.energy_J + share * (deeper.energy_J - below.energy_J)};
  }
  return deeper.energy_J;
}

// The mean since the last sample of the force that was written a delay ago. Assuming too large a lag
// makes the debt during unloading larger, never smaller.
double PassivityController::arrived_N(const Tool& tool, const Timing& timing, double written_N) noexcept {
  time_s_ += timing.step_s;
  written_[ticks_ % kMostUnderWay] = {time_s_, written_N};
  const double latest_s = time_s_ - timing.delay_s + 0.5 * timing.tick_s;
  std::size_t ago = 0;
  while (ago < std::min(ticks_, kMostUnderWay - 1) && written_[(ticks_ - ago) % kMostUnderWay].time_s > latest_s) ++ago;
  arrived_N_ += written_[(ticks_ - ago) % kMostUnderWay].force_N;
  ++ticks_;
  ++arrivals_;
  const double mean_N = arrived_N_ / arrivals_;
  if (tool.fresh) {
    arrived_N_ = 0.0;
    arrivals_ = 0;
  }
  return mean_N;
}

double PassivityController::apply(double commanded_N, const Tool& tool, const Timing& timing, double damping_Ns_per_m,
                                  double written_N) noexcept {
  const double acted_N = arrived_N(tool, timing, written_N), step_s = timing.step_s;
  since_sample_s_ += step_s;
  if (tool.fresh) hold_s_ = std::exchange(since_sample_s_, 0.0);
  if (!tool.in_contact || !std::isfinite(tool.position_m)) {
    begin_at(0.0);
    return reduced(commanded_N, 0.0);
  }
  if (tool.model_changing) {
    begin_at(tool.position_m);
    return reduced(commanded_N, reduction_N_ * std::max(0.0, 1.0 - step_s / kLetGo_s));
  }
  const double half_play_m = 0.5 * play_m_;
  const double depth_m = std::clamp(depth_m_, tool.position_m - half_play_m, tool.position_m + half_play_m);
  const double change_m = depth_m - depth_m_, before_J = energy_J_;
  energy_J_ += acted_N * change_m;
  if (change_m >= 0.0) {
    if (depth_m > passed_[count_ - 1].depth_m + kSpacing_m) pass_inwards(depth_m, energy_J_ + debt_J_);
  } else {
    // Adds the turning point, unless it was added before.
    if (depth_m_ > passed_[count_ - 1].depth_m) pass_inwards(depth_m_, before_J + debt_J_);
    if (depth_m < passed_[0].depth_m)
      begin_at(depth_m);  // further out than the beginning: there is no reference
    else
      debt_J_ = std::max(0.0, energy_when_passed(depth_m) - energy_J_);
  }
  depth_m_ = depth_m;
  const double out_m_per_s = -tool.velocity_m_per_s;
  if (!(debt_J_ > 0.0) || !(out_m_per_s > 0.0) || !(step_s > 0.0)) return reduced(commanded_N, 0.0);
  const double needed_Ns_per_m = debt_J_ / (out_m_per_s * out_m_per_s * std::max(timing.tick_s, hold_s_));
  return reduced(commanded_N, std::min(damping_Ns_per_m, needed_Ns_per_m) * out_m_per_s);
}

double PassivityController::reduced(double commanded_N, double reduction_N) noexcept {
  reduction_N_ = reduction_N;
  if (reduction_N == 0.0) return commanded_N;
  return commanded_N > reduction_N ? commanded_N - reduction_N : std::min(commanded_N, 0.0);
}

}  // namespace palpate
