#include "scenes/study/study_session.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace palpate {
namespace {

// The largest allowed difference between rendered and commanded force at any tick: half the JND at 0 N. A trial that
// exceeds it is presented again.
const double kMostAway_N = 0.5 * JndLine{}.at(0.0);

double to_tenth_mN(double force_N) noexcept { return std::round(force_N * 1e4) / 1e4; }

Error unexpected_answer(const StudyRecord& record) {
  return Error{std::string("the stored ") + (record.training ? "training answer " : "answer ") +
               std::to_string(record.number) +
               " is to a trial that this subject's plan does not have there; was the file made by another "
               "version, or changed? Start a new file"};
}

Status check_strokes(const StrokePair* strokes) {
  if (strokes == nullptr) return {};
  if (strokes->reference_N.size() == kInterval_ticks && strokes->comparison_N.size() == kInterval_ticks) return {};
  return Error{"found no two strokes of " + std::to_string(kInterval_ticks) + " ms, expected them to be told apart"};
}

}  // namespace

std::string study_consent_text(bool strokes) {
  const std::string task =
      strokes
          ? "Each time you feel three pushes, one after the other, and say which of the last two was like the first."
          : "Each time you feel two pushes, one after the other, and say which was the larger.";
  return "In this study you hold a device that pushes gently against your hand, with at most 4 N (the weight "
         "of 400 g). " +
         task +
         " Hold your hand still. There are breaks.\n"
         "Stored are your answers, how long they took and the code that you were given; not your name.\n"
         "Taking part is voluntary. You can stop at any time and without a reason with the abort key; the "
         "force then goes away at once.\n"
         "Do you agree to take part?";
}

double StudyRecord::rendered_difference() const noexcept {
  const double comparison_N = trial.comparison_first ? first_rendered_N : second_rendered_N;
  const double reference_N = trial.comparison_first ? second_rendered_N : first_rendered_N;
  return (comparison_N - reference_N) / reference_N;
}

Result<std::unique_ptr<StudySession>> StudySession::create(const StudyHeader& header, std::unique_ptr<StudyStore> store,
                                                           std::uint64_t rest_ticks) {
  if (const Status code = check_subject_code(header.subject); !code) return code.error();
  if (const Status strokes = check_strokes(header.strokes.get()); !strokes) return strokes.error();
  std::unique_ptr<StudySession> session(new StudySession(header, std::move(store), rest_ticks));
  if (const Status resumed = session->resume(); !resumed) return resumed.error();
  return session;
}

StudySession::StudySession(const StudyHeader& header, std::unique_ptr<StudyStore> store, std::uint64_t rest_ticks)
    : header_(header),
      store_(std::move(store)),
      rest_ticks_(rest_ticks),
      plan_(plan_study(header.subject, header.strokes.get())) {}

// Counts the stored answers; each must belong to the next trial of the plan.
Status StudySession::resume() {
  for (const StudyRecord& record : store_->records()) {
    const bool fits = record.training == training() && (training() || !all_answered()) &&
                      record.trial == next_trial() && record.number == next_number();
    if (!fits) return unexpected_answer(record);
    ++(record.training ? trained_ : answered_);
  }
  if (!store_->consented()) return {};
  state_ = all_answered() ? StudyState::done : StudyState::ready;
  return {};
}

void StudySession::accept_consent(const std::string& when) {
  if (state_ != StudyState::consent) return;
  const Status written = store_->consent(study_consent_text(header_.strokes != nullptr), when);
  problem_ = written ? "" : written.error().message;
  if (written) state_ = StudyState::ready;
}

void StudySession::proceed() {
  const bool rested = state_ == StudyState::rest && presenter_.newest().tick >= rest_from_ + rest_ticks_;
  if (state_ == StudyState::ready || rested) present_next();
}

void StudySession::present_next() {
  trial_ = next_trial();
  presentation_ = presenter_.present(plan_.stimuli(trial_, training()));
  state_ = StudyState::presenting;
}

void StudySession::update() {
  if (state_ != StudyState::presenting) return;
  const PresentationState& seen = presenter_.newest();
  if (seen.presentation != presentation_ || seen.phase != PresentationPhase::finished) return;
  dropped_out_ = header_.rendered && seen.worst_N > kMostAway_N;
  state_ = dropped_out_ ? StudyState::ready : StudyState::answering;
}

void StudySession::answer(bool second) {
  if (state_ != StudyState::answering) return;
  const PresentationState& seen = presenter_.newest();
  record_ = {};
  record_.training = training();
  record_.number = next_number();
  record_.trial = trial_;
  record_.first_rendered_N = to_tenth_mN(seen.first_rendered_N);
  record_.second_rendered_N = to_tenth_mN(seen.second_rendered_N);
  if (header_.strokes != nullptr) {
    record_.reminder_rendered_N = to_tenth_mN(seen.reminder_rendered_N);
    record_.worst_N = to_tenth_mN(seen.worst_N);
  }
  record_.limited = seen.limited;
  record_.answered_second = second;
  record_.response_ms = static_cast<std::uint32_t>(
      std::min<std::uint64_t>(seen.tick - seen.finished_at, std::numeric_limits<std::uint32_t>::max()));
  save();
}

void StudySession::retry() {
  if (state_ == StudyState::unsaved) save();
}

void StudySession::save() {
  const Status written = store_->append(record_);
  if (!written) {
    problem_ = written.error().message;
    state_ = StudyState::unsaved;
    return;
  }
  problem_.clear();
  continue_session();
}

// Called after an answer is on the disk.
void StudySession::continue_session() {
  if (record_.training) {
    ++trained_;
    if (training()) return present_next();
    state_ = StudyState::ready;
    return;
  }
  ++answered_;
  if (all_answered()) {
    state_ = StudyState::done;
  } else if (answered_ % plan_.trials_per_block == 0) {
    rest_from_ = presenter_.newest().tick;
    state_ = StudyState::rest;
  } else {
    present_next();
  }
}

void StudySession::abort() {
  presenter_.stop();
  if (state_ == StudyState::done || state_ == StudyState::aborted) return;
  if (state_ == StudyState::unsaved) {
    const Status written = store_->append(record_);
    problem_ = written ? "" : written.error().message;
  }
  state_ = StudyState::aborted;
}

StudyView StudySession::view() {
  StudyView view;
  view.state = state_;
  view.training = training();
  view.answered = training() ? trained_ : answered_;
  view.trials = training() ? plan_.training.size() : plan_.trials.size();
  view.has_feedback = record_.training && state_ != StudyState::unsaved;
  view.was_correct = header_.strokes != nullptr ? record_.found_reference() : record_.found_larger();
  const PresentationState& seen = presenter_.newest();
  view.has_reminder = header_.strokes != nullptr;
  if (state_ == StudyState::presenting && seen.presentation == presentation_) {
    view.reminder = seen.phase == PresentationPhase::reminder;
    view.interval = seen.phase == PresentationPhase::first ? 1 : seen.phase == PresentationPhase::second ? 2 : 0;
  }
  if (state_ == StudyState::rest) {
    const std::uint64_t until = rest_from_ + rest_ticks_;
    view.rest_ticks_left = until > seen.tick ? until - seen.tick : 0;
  }
  view.message = message(view);
  return view;
}

std::string StudySession::message(const StudyView& view) const {
  switch (state_) {
    case StudyState::consent:
      return problem_.empty() ? study_consent_text(header_.strokes != nullptr) : problem_;
    case StudyState::ready:
      if (dropped_out_)
        return "The device was not ready for a moment. The same pushes come again; go on when you are ready.";
      if (!view.training) return "Now the study itself. Go on when you are ready.";
      return view.has_reminder
                 ? "First a few trials to learn the task. Which of the two pushes was like the "
                   "reference? Go on when you are ready."
                 : "First a few trials to learn the task. Which push was larger? Go on when you are ready.";
    case StudyState::presenting:
      if (view.reminder) return "The reference";
      return view.interval == 1 ? "First push" : view.interval == 2 ? "Second push" : "Hold still";
    case StudyState::answering:
      return view.has_reminder ? "Which was like the reference, 1 or 2?"
                               : "Which push was larger, the first or the second?";
    case StudyState::unsaved:
      return "Your answer could not be stored: " + problem_ + ". Call the experimenter.";
    case StudyState::rest:
      return "A break. Relax your hand; go on when you are ready.";
    case StudyState::done:
      return "That was all. Thank you!";
    case StudyState::aborted:
      return problem_.empty() ? "The session was ended; all answers are stored."
                              : "The session was ended; the last answer could not be stored: " + problem_;
  }
  return {};
}

}  // namespace palpate
