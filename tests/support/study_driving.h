// Takes a study session through its states as a subject in front of it would.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>

#include "scenes/study/study_session.h"

namespace palpate::test {

// Forces of a few ticks, for tests that have hundreds of trials.
inline constexpr StudyTiming kQuickTiming{5, 60, 20, 5};

// A force that grows from 1 N by 0.01 N a tick, and `share` of it, for an interval.
inline std::shared_ptr<const StrokePair> example_strokes(double share, const StudyTiming& timing = kQuickTiming) {
  auto strokes = std::make_shared<StrokePair>();
  strokes->reference = "recorded force";
  strokes->comparison = "greedy-100";
  strokes->recording = "silicone 2";
  strokes->from_s = 12.3;
  strokes->to_s = 12.44;
  strokes->checksum = static_cast<std::uint32_t>(std::lround(1000.0 * share));
  double sum_N = 0.0;
  for (std::uint32_t i = 0; i < timing.interval(); ++i) {
    const double force_N = 1.0 + 0.01 * i;
    strokes->reference_N.push_back(force_N);
    strokes->comparison_N.push_back(share * force_N);
    if (i >= timing.ramp && i < timing.ramp + timing.hold) sum_N += force_N / timing.hold;
  }
  strokes->reference_mean_N = std::round(1e4 * sum_N) / 1e4;
  strokes->comparison_mean_N = std::round(1e4 * share * sum_N) / 1e4;
  // Largest at the largest force, 1.7 N while it is let through whole.
  strokes->mean_over_jnd = strokes->max_over_jnd = std::abs(share - 1.0) * 1.7 / strokes->jnd.at(1.7);
  return strokes;
}

inline StudyHeader discrimination_header(double share) {
  return {"S01", ProcedureKind::discriminate, kQuickTiming, example_strokes(share)};
}

// Ticks until the session wants something of the subject (at most one minute).
inline void run_until_asked(StudySession& session) {
  double rendered_N = 0.0;
  for (int i = 0; i < 60000 && session.state() == StudyState::presenting; ++i) {
    rendered_N = session.tick(rendered_N);
    session.update();
  }
}

// Answers `trials` trials, training included, by `second_is_larger`; goes on where
// it can. Returns how many were answered.
inline std::size_t answer_trials(StudySession& session, std::size_t trials,
                                 const std::function<bool(const StudyTrial&)>& second_is_larger) {
  std::size_t answered = 0;
  while (answered < trials) {
    if (session.state() == StudyState::ready || session.state() == StudyState::rest) session.proceed();
    run_until_asked(session);
    if (session.state() != StudyState::answering) break;
    session.answer(second_is_larger(session.trial()));
    if (session.state() == StudyState::unsaved) break;
    ++answered;
  }
  return answered;
}

// Right about which of two strokes is like the reference.
inline bool truly_like(const StudyTrial& trial) { return trial.comparison_first; }

inline bool truly_larger(const StudyTrial& trial) { return trial.second_N() > trial.first_N(); }

}  // namespace palpate::test
