#include "scenes/study/study_presenter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate {

double interval_share(std::uint32_t tick) noexcept {
  const std::uint32_t from_edge = std::min(tick, kInterval_ticks - 1 - tick);
  if (from_edge >= kRamp_ticks) return 1.0;
  return 0.5 - 0.5 * std::cos(std::numbers::pi * static_cast<double>(from_edge) / kRamp_ticks);
}

double Stimulus::force_N(std::uint32_t tick) const noexcept {
  const double now_N = size * interval_share(tick);
  if (stroke_N == nullptr) return now_N;
  return tick < stroke_N->size() ? now_N * (*stroke_N)[tick] : 0.0;
}

std::uint64_t StudyPresenter::present(const Stimuli& stimuli) noexcept {
  orders_.write({++ordered_, stimuli});
  return ordered_;
}

void StudyPresenter::record(double rendered_N) noexcept {
  if (state_.interval < 0 || !std::isfinite(rendered_N)) return;
  state_.worst_N = std::max(state_.worst_N, std::abs(rendered_N - commanded_N_));
  if (is_held(in_interval_)) state_.rendered_N[static_cast<std::size_t>(state_.interval)] += rendered_N / kHold_ticks;
}

double StudyPresenter::next_command_N() noexcept {
  state_.interval = -1;
  if (stopped_.load(std::memory_order_acquire) || state_.presentation == 0 || state_.finished_at > 0) return 0.0;
  const std::uint32_t now = played_++;
  if (now < kLeadIn_ticks) return 0.0;
  const Stimuli& stimuli = orders_.value().stimuli;
  const std::uint32_t since = now - kLeadIn_ticks, period = kInterval_ticks + kPause_ticks;
  const std::uint32_t interval = since / period + (has_reminder(stimuli) ? 0 : 1);
  in_interval_ = since % period;
  if (in_interval_ < kInterval_ticks) {
    state_.interval = static_cast<int>(interval);
    return stimuli[interval].force_N(in_interval_);
  }
  if (interval == 2) state_.finished_at = state_.tick;
  return 0.0;
}

double StudyPresenter::tick(double rendered_N) noexcept {
  record(rendered_N);
  if (orders_.refresh()) {
    state_ = {.presentation = orders_.value().presentation, .tick = state_.tick};
    played_ = 0;
  }
  commanded_N_ = next_command_N();
  const double force_N = limiter_.limit(commanded_N_, kHapticTick_s);
  const auto changed = force_limit::kClamped | force_limit::kSlewed | force_limit::kNotFinite;
  if ((limiter_.flags() & changed) != 0) state_.limited = true;
  ++state_.tick;
  states_.write(state_);
  return force_N;
}

}  // namespace palpate
