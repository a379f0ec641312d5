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

std::uint64_t StudyPresenter::present(const Stimuli& stimuli) noexcept {
  orders_.write({++ordered_, stimuli});
  return ordered_;
}

std::uint32_t StudyPresenter::length(PresentationPhase phase) const noexcept {
  const bool reminds = phase == PresentationPhase::reminder || phase == PresentationPhase::reminder_pause;
  const bool pauses = phase == PresentationPhase::pause || phase == PresentationPhase::reminder_pause;
  if (phase == PresentationPhase::lead_in) return kLeadIn_ticks;
  if (reminds && order_.stimuli.reminder.stroke_N == nullptr) return 0;
  if (phase == PresentationPhase::idle || phase >= PresentationPhase::finished) return 0;
  return pauses ? kPause_ticks : kInterval_ticks;
}

const Stimulus* StudyPresenter::stimulus() const noexcept {
  return state_.phase == PresentationPhase::reminder ? &order_.stimuli.reminder
         : state_.phase == PresentationPhase::first  ? &order_.stimuli.first
         : state_.phase == PresentationPhase::second ? &order_.stimuli.second
                                                     : nullptr;
}

bool StudyPresenter::is_held() const noexcept {
  return stimulus() != nullptr && in_phase_ >= kRamp_ticks && in_phase_ < kRamp_ticks + kHold_ticks;
}

double StudyPresenter::commanded_N() const noexcept {
  const Stimulus* now = stimulus();
  if (now == nullptr) return 0.0;
  const double force_N = now->size * interval_share(in_phase_);
  if (now->stroke_N == nullptr) return force_N;
  return in_phase_ < now->stroke_N->size() ? force_N * (*now->stroke_N)[in_phase_] : 0.0;
}

void StudyPresenter::read_orders() noexcept {
  if (stopped_.load(std::memory_order_acquire)) {
    state_.phase = PresentationPhase::stopped;
    return;
  }
  if (!orders_.refresh()) return;
  order_ = orders_.value();
  state_.presentation = order_.presentation;
  state_.phase = PresentationPhase::lead_in;
  state_.first_rendered_N = state_.second_rendered_N = state_.reminder_rendered_N = 0.0;
  state_.worst_N = 0.0;
  state_.limited = false;
  in_phase_ = 0;
}

// Records the force that the device rendered for the last tick.
void StudyPresenter::record(double rendered_N) noexcept {
  if (!sent_stimulus_ || !std::isfinite(rendered_N)) return;
  state_.worst_N = std::max(state_.worst_N, std::abs(rendered_N - sent_commanded_N_));
  if (!sent_held_) return;
  double& mean_N = sent_phase_ == PresentationPhase::first    ? state_.first_rendered_N
                   : sent_phase_ == PresentationPhase::second ? state_.second_rendered_N
                                                              : state_.reminder_rendered_N;
  mean_N += rendered_N / kHold_ticks;
}

void StudyPresenter::advance() noexcept {
  while (state_.phase != PresentationPhase::idle && state_.phase < PresentationPhase::finished &&
         in_phase_ >= length(state_.phase)) {
    state_.phase = static_cast<PresentationPhase>(static_cast<int>(state_.phase) + 1);
    in_phase_ = 0;
    if (state_.phase == PresentationPhase::finished) state_.finished_at = state_.tick;
  }
}

double StudyPresenter::tick(double rendered_N) noexcept {
  record(rendered_N);
  read_orders();
  advance();
  sent_commanded_N_ = commanded_N();
  state_.force_N = limiter_.limit(sent_commanded_N_, kStudyTick_s);
  if (limiter_.flags() & (force_limit::kClamped | force_limit::kSlewed | force_limit::kNotFinite)) {
    state_.limited = true;
  }
  sent_phase_ = state_.phase;
  sent_stimulus_ = stimulus() != nullptr;
  sent_held_ = is_held();
  ++in_phase_;
  ++state_.tick;
  states_.write(state_);
  return state_.force_N;
}

}  // namespace palpate
