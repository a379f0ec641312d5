// Takes a study session through its states as a subject in front of it would.
#pragma once

#include <cstddef>
#include <functional>

#include "scenes/study/study_session.h"

namespace palpate::test {

// Forces of a few ticks, for tests that have hundreds of trials.
inline constexpr StudyTiming kQuickTiming{5, 60, 20, 5};

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

inline bool truly_larger(const StudyTrial& trial) { return trial.second_N() > trial.first_N(); }

}  // namespace palpate::test
