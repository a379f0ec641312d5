// One subject's session: consent, training, trials, breaks, the end. A state machine without window and clock; time is
// counted in ticks of 1 ms.
//
//   consent -> ready -> presenting -> answering -> presenting ... -> rest -> ... -> done
//   presenting -> ready (the device did not render the planned force; the trial is repeated)
//   any of them -> aborted
//
// The haptics thread calls `next_force_N` once per ms and renders the result. The slow thread calls `update` in every
// frame, draws `view`, and forwards the subject's input. The state is `ready` before the training, before the study
// and when a session is resumed. A break lasts at least `rest_ticks`. `answer` stores the answer before it returns; if
// that fails, the session still waits for the answer, and the view says why.
// Thread guarantee: `next_force_N` on the haptics thread, wait-free, no allocation; the rest on one slow thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "engine/live/live_tick.h"
#include "scenes/study/study_file.h"

namespace palpate {

enum class StudyState : std::uint8_t { consent, ready, presenting, answering, rest, done, aborted };

// Contents of the subject's screen.
struct StudyView {
  StudyState state = StudyState::consent;
  bool training = false;
  std::size_t answered = 0;  // in this part: training or study
  std::size_t trials = 0;    // in this part
  int interval = -1;         // that is presented now: 0 the reminder, 1 or 2; -1 none
  std::uint64_t rest_ticks_left = 0;
  std::optional<bool> was_correct;  // the last answer; only in the training
  std::string message;              // one or two sentences for the subject
};

class StudySession final : public ForceSource {
 public:
  static constexpr std::uint64_t kRest_ticks = 30000;

  // Resumes after the last answer in `file`. Errors: an invalid subject code, strokes that do not fill an interval,
  // stored answers that do not match the plan.
  static Result<std::unique_ptr<StudySession>> create(std::unique_ptr<StudyFile> file,
                                                      std::uint64_t rest_ticks = kRest_ticks);

  // Slow thread. Calls that do not fit the state have no effect.
  void accept_consent(const std::string& when);
  void proceed();            // leaves `ready`, and `rest` after `rest_ticks`
  void update();             // processes the ticks since the last call
  void answer(bool second);  // whether the second was the larger, or like the reminder
  void abort();              // from any state except `done`

  StudyView view();
  StudyState state() const noexcept { return state_; }
  const StudyFile& file() const noexcept { return *file_; }
  // The current trial.
  const StudyTrial& trial() const { return plan_.trials.at(answered()); }

  // Haptics thread; see StudyPresenter.
  double next_force_N(double rendered_N) noexcept override { return presenter_.tick(rendered_N); }

 private:
  StudySession(std::unique_ptr<StudyFile> file, std::uint64_t rest_ticks);
  Status check_stored() const;
  std::size_t answered() const noexcept { return file_->records().size(); }
  bool training() const noexcept { return answered() < plan_.training; }
  bool has_reminder() const noexcept { return plan_.strokes != nullptr; }
  std::string message(const StudyView& view) const;
  void present_next();

  std::unique_ptr<StudyFile> file_;
  std::uint64_t rest_ticks_;
  StudyPlan plan_;
  StudyPresenter presenter_;

  StudyState state_ = StudyState::consent;
  std::uint64_t presentation_ = 0;
  std::uint64_t rest_until_ = 0;
  bool dropped_out_ = false;  // the device did not render the last presentation as planned
  std::string problem_;       // error message of the file
};

}  // namespace palpate
