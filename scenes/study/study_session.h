// One subject's session: consent, training, trials, breaks, the end. A state machine without window and clock; time is
// counted in ticks of 1 ms.
//
//   consent -> ready -> presenting -> answering -> presenting ... -> rest -> ... -> done
//                                         |  ^
//                                      unsaved (the answer could not be stored)
//   presenting -> ready (the device did not render the planned force; the trial is repeated)
//   any of them -> aborted
//
// The haptics thread calls `next_force_N` once per ms and renders the result. The slow thread calls `update` in every
// frame, draws `view`, and forwards the subject's input. The state is `ready` before the training, before the study
// and when a session is resumed. A break lasts at least `rest_ticks`. `answer` stores the answer before it returns; if
// that fails, the session is `unsaved` until `retry` succeeds. `abort` tries once more to store such an answer; no
// other answer can be lost. Thread guarantee: `next_force_N` on the haptics thread, wait-free, no allocation; the rest
// on one slow thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/live/live_tick.h"
#include "scenes/study/study_plan.h"
#include "scenes/study/study_presenter.h"
#include "scenes/study/study_store.h"

namespace palpate {

// The information that a subject has to consent to.
std::string study_consent_text(bool strokes);

enum class StudyState : std::uint8_t { consent, ready, presenting, answering, unsaved, rest, done, aborted };

// Contents of the subject's screen.
struct StudyView {
  StudyState state = StudyState::consent;
  bool training = false;
  std::size_t answered = 0;   // in this part: training or study
  std::size_t trials = 0;     // in this part
  bool has_reminder = false;  // a reminder precedes the two forces
  bool reminder = false;      // the reminder is presented now
  int interval = 0;           // 1 or 2 while that force is presented, else 0
  std::uint64_t rest_ticks_left = 0;
  bool has_feedback = false;  // after an answer of the training
  bool was_correct = false;
  std::string message;  // one or two sentences for the subject
};

class StudySession final : public ForceSource {
 public:
  static constexpr std::uint64_t kRest_ticks = 30000;

  // Resumes after the last answer in `store`. Errors: an invalid subject code, strokes that do not fill an interval,
  // stored answers that do not match the plan.
  static Result<std::unique_ptr<StudySession>> create(const StudyHeader& header, std::unique_ptr<StudyStore> store,
                                                      std::uint64_t rest_ticks = kRest_ticks);

  // Slow thread. Calls that do not fit the state have no effect.
  void accept_consent(const std::string& when);
  void proceed();            // leaves `ready`, and `rest` after `rest_ticks`
  void update();             // processes the ticks since the last call
  void answer(bool second);  // whether the second was the larger, or like the reminder
  void retry();              // leaves `unsaved`
  void abort();              // from any state

  StudyView view();
  StudyState state() const noexcept { return state_; }
  const StudyHeader& header() const noexcept { return header_; }
  const StudyStore& store() const noexcept { return *store_; }
  // The current trial.
  const StudyTrial& trial() const noexcept { return trial_; }
  bool training() const noexcept { return trained_ < plan_.training.size(); }

  // Haptics thread; see StudyPresenter.
  double next_force_N(double rendered_N) noexcept override { return presenter_.tick(rendered_N); }

 private:
  StudySession(const StudyHeader& header, std::unique_ptr<StudyStore> store, std::uint64_t rest_ticks);
  Status resume();
  bool all_answered() const noexcept { return answered_ == plan_.trials.size(); }
  std::size_t next_number() const noexcept { return (training() ? trained_ : answered_) + 1; }
  const StudyTrial& next_trial() const { return training() ? plan_.training[trained_] : plan_.trials[answered_]; }
  std::string message(const StudyView& view) const;
  void present_next();
  void save();
  void continue_session();

  StudyHeader header_;
  std::unique_ptr<StudyStore> store_;
  std::uint64_t rest_ticks_;
  StudyPlan plan_;
  StudyPresenter presenter_;

  StudyState state_ = StudyState::consent;
  std::size_t trained_ = 0;   // answered trials of the training
  std::size_t answered_ = 0;  // answered trials of the study
  StudyTrial trial_;
  StudyRecord record_;  // the last answer
  std::uint64_t presentation_ = 0;
  std::uint64_t rest_from_ = 0;
  bool dropped_out_ = false;  // the device did not render the last presentation as planned
  std::string problem_;       // error message of the store
};

}  // namespace palpate
