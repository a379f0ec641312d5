#include "scenes/study/study_presenter.h"

#include <cmath>
#include <string>

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
  if (timing.hold < 1 || timing.hold > kLongestStudyForce_ticks ||
      timing.interval() > kLongestStudyForce_ticks) {
    return wrong("hold", timing.hold, "1 ms or more, and 5000 ms at most together with both ramps");
  }
  if (timing.lead_in > kLongestWait) return wrong("lead-in", timing.lead_in, "60000 ms at most");
  if (timing.pause > kLongestWait) return wrong("pause", timing.pause, "60000 ms at most");
  return {};
}

std::uint64_t StudyPresenter::present(double first_N, double second_N) noexcept {
  orders_.write({++ordered_, first_N, second_N});
  return ordered_;
}

std::uint32_t StudyPresenter::length(PresentationPhase phase) const noexcept {
  switch (phase) {
    case PresentationPhase::lead_in: return timing_.lead_in;
    case PresentationPhase::first:
    case PresentationPhase::second: return timing_.interval();
    case PresentationPhase::pause: return timing_.pause;
    default: return 0;
  }
}

bool StudyPresenter::is_held() const noexcept {
  const bool interval = state_.phase == PresentationPhase::first || state_.phase == PresentationPhase::second;
  return interval && in_phase_ >= timing_.ramp && in_phase_ < timing_.ramp + timing_.hold;
}

// Of the full force, within an interval.
double StudyPresenter::share() const noexcept {
  const std::uint32_t left = timing_.interval() - 1 - in_phase_;
  const std::uint32_t from_edge = in_phase_ < left ? in_phase_ : left;
  if (from_edge >= timing_.ramp) return 1.0;
  return 0.5 - 0.5 * std::cos(kPi * static_cast<double>(from_edge) / static_cast<double>(timing_.ramp));
}

void StudyPresenter::take_orders() noexcept {
  if (stopped_.load(std::memory_order_acquire)) {
    state_.phase = PresentationPhase::stopped;
    return;
  }
  if (!orders_.refresh()) return;
  order_ = orders_.value();
  state_.presentation = order_.presentation;
  state_.phase = PresentationPhase::lead_in;
  state_.first_rendered_N = state_.second_rendered_N = 0.0;
  state_.limited = false;
  in_phase_ = 0;
}

// Adds the last tick's force to the mean of its interval.
void StudyPresenter::record(double rendered_N) noexcept {
  if (!sent_held_ || !std::isfinite(rendered_N)) return;
  const double share = rendered_N / static_cast<double>(timing_.hold);
  (sent_phase_ == PresentationPhase::first ? state_.first_rendered_N : state_.second_rendered_N) += share;
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
  sent_held_ = false;
  take_orders();
  advance();
  double wanted_N = 0.0;
  if (state_.phase == PresentationPhase::first) wanted_N = order_.first_N * share();
  if (state_.phase == PresentationPhase::second) wanted_N = order_.second_N * share();
  state_.force_N = limiter_.limit(wanted_N, kStudyTick_s);
  if (limiter_.flags() & (force_limit::kClamped | force_limit::kSlewed | force_limit::kNotFinite)) {
    state_.limited = true;
  }
  sent_phase_ = state_.phase;
  sent_held_ = is_held();
  ++in_phase_;
  ++state_.tick;
  states_.write(state_);
  return state_.force_N;
}

}  // namespace palpate
