// Drives a study session through its states, as a subject does.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "scenes/study/study_session.h"

namespace palpate::test {

// A session with the study file `path`, which may exist.
inline Result<std::unique_ptr<StudySession>> session_at(const std::string& path, const StudyHeader& header = {"S01"},
                                                        std::uint64_t rest_ticks = 0) {
  auto file = StudyFile::open(path, header);
  if (!file) return file.error();
  return std::make_unique<StudySession>(std::move(*file), rest_ticks);
}

// An interval of a force that grows from 1 N by 1 mN per tick, and of `share` times that force.
inline std::shared_ptr<const StrokePair> example_strokes(double share) {
  auto strokes = std::make_shared<StrokePair>();
  strokes->reference = "recorded force";
  strokes->comparison = "greedy-100";
  strokes->recording = "silicone 2";
  strokes->from_s = 12.3;
  strokes->checksum = static_cast<std::uint64_t>(std::lround(1000.0 * share));
  double sum_N = 0.0;
  for (std::uint32_t i = 0; i < kInterval_ticks; ++i) {
    const double force_N = 1.0 + 0.001 * i;
    strokes->reference_N.push_back(force_N);
    strokes->comparison_N.push_back(share * force_N);
    if (is_held(i)) sum_N += force_N / kHold_ticks;
  }
  strokes->reference_mean_N = std::round(1e4 * sum_N) / 1e4;
  strokes->comparison_mean_N = std::round(1e4 * share * sum_N) / 1e4;
  // The maximum is at the largest unlimited force, 2 N.
  strokes->mean_over_jnd = strokes->max_over_jnd = std::abs(share - 1.0) * 2.0 / strokes->jnd.at(2.0);
  return strokes;
}

inline StudyHeader discrimination_header(double share) { return {"S01", example_strokes(share)}; }

// Ticks until the session waits for the subject (at most one minute).
inline void run_until_asked(StudySession& session) {
  double rendered_N = 0.0;
  for (int i = 0; i < 60000 && session.state() == StudyState::presenting; ++i) {
    rendered_N = session.next_force_N(rendered_N);
    session.update();
  }
}

// Answers `trials` trials, including training, by `second_is_larger`. Returns the
// number of answered trials.
inline std::size_t answer_trials(StudySession& session, std::size_t trials,
                                 const std::function<bool(const StudyTrial&)>& second_is_larger) {
  std::size_t answered = 0;
  while (answered < trials) {
    if (session.state() == StudyState::ready || session.state() == StudyState::rest) session.proceed();
    run_until_asked(session);
    if (session.state() != StudyState::answering) break;
    session.answer(second_is_larger(session.trial()));
    if (session.state() == StudyState::answering) break;  // the answer could not be stored
    ++answered;
  }
  return answered;
}

// The correct answers, true for the second: which stroke equals the reference; which force is larger.
inline bool truly_like(const StudyTrial& trial) { return trial.comparison_first; }

inline bool truly_larger(const StudyTrial& trial) { return trial.second_N() > trial.first_N(); }

}  // namespace palpate::test
