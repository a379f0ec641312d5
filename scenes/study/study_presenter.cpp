#include "scenes/study/study_presenter.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace palpate {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr std::uint32_t kShortestRamp = 60;  // 3.5 N x pi / 2 / 60 ms is 92 N/s
constexpr std::uint32_t kLongestWait = 60000;

Error wrong(const char* what, std::uint32_t found, const std::string& expected) {
  return Error{std::string("found a ") + what + " of " + std::to_string(found) + " ms, expected " + expected};
}

}  // namespace

Status check_study_timing(const StudyTiming& timing) {
  if (timing.ramp < kShortestRamp || timing.ramp > kLongestStudyForce_ticks) {
    return wrong("ramp", timing.ramp, "60 to 5000 ms");
  }
  if (timing.hold < 1 || timing.hold > kLongestStudyForce_ticks || timing.interval() > kLongestStudyForce_ticks) {
    return wrong("hold", timing.hold, "1 ms or more, and 5000 ms at most together with both ramps");
  }
  if (timing.lead_in > kLongestWait) return wrong("lead-in", timing.lead_in, "60000 ms at most");
  if (timing.pause > kLongestWait) return wrong("pause", timing.pause, "60000 ms at most");
  return {};
}

double interval_share(const StudyTiming& timing, std::uint32_t tick) noexcept {
  const std::uint32_t left = timing.interval() - 1 - tick;
  const std::uint32_t from_edge = tick < left ? tick : left;
  if (from_edge >= timing.ramp) return 1.0;
  return 0.5 - 0.5 * std::cos(kPi * static_cast<double>(from_edge) / static_cast<double>(timing.ramp));
}

std::uint64_t StudyPresenter::present(const Stimuli& stimuli) noexcept {
  orders_.write({++ordered_, stimuli});
  return ordered_;
}

std::uint32_t StudyPresenter::length(PresentationPhase phase) const noexcept {
  const bool reminds = phase == PresentationPhase::reminder || phase == PresentationPhase::reminder_pause;
  const bool pauses = phase == PresentationPhase::pause || phase == PresentationPhase::reminder_pause;
  if (phase == PresentationPhase::lead_in) return timing_.lead_in;
  if (reminds && !order_.stimuli.has_reminder) return 0;
  if (phase == PresentationPhase::idle || phase >= PresentationPhase::finished) return 0;
  return pauses ? timing_.pause : timing_.interval();
}

const Stimulus* StudyPresenter::stimulus() const noexcept {
  return state_.phase == PresentationPhase::reminder ? &order_.stimuli.reminder
         : state_.phase == PresentationPhase::first  ? &order_.stimuli.first
         : state_.phase == PresentationPhase::second ? &order_.stimuli.second
                                                     : nullptr;
}

bool StudyPresenter::is_held() const noexcept {
  return stimulus() != nullptr && in_phase_ >= timing_.ramp && in_phase_ < timing_.ramp + timing_.hold;
}

double StudyPresenter::commanded_N() const noexcept {
  const Stimulus* now = stimulus();
  if (now == nullptr) return 0.0;
  const double force_N = now->size * interval_share(timing_, in_phase_);
  if (now->kind == StimulusKind::constant) return force_N;
  if (strokes_ == nullptr) return 0.0;
  const std::vector<double>& stroke_N =
      now->kind == StimulusKind::reference ? strokes_->reference_N : strokes_->comparison_N;
  return in_phase_ < stroke_N.size() ? force_N * stroke_N[in_phase_] : 0.0;
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

// Takes in what became of the last tick's force.
void StudyPresenter::record(double rendered_N) noexcept {
  if (!sent_stimulus_ || !std::isfinite(rendered_N)) return;
  state_.worst_N = std::max(state_.worst_N, std::abs(rendered_N - sent_commanded_N_));
  if (!sent_held_) return;
  double& mean_N = sent_phase_ == PresentationPhase::first    ? state_.first_rendered_N
                   : sent_phase_ == PresentationPhase::second ? state_.second_rendered_N
                                                              : state_.reminder_rendered_N;
  mean_N += rendered_N / static_cast<double>(timing_.hold);
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
