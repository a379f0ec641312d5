// One subject's session: consent, training, trials, breaks, the end. A state
// machine without window and without clock: time is what the ticks count.
//
//   consent -> ready -> presenting -> answering -> presenting ... -> rest -> ... -> done
//                                         |  ^
//                                      unsaved (the disk refused the answer)
//   presenting -> ready (the device did not render what it should; the trial comes again)
//   any of them -> aborted
//
// How to drive it: the haptics thread calls `next_force_N` once per ms and renders what it
// returns. The slow thread calls `update` in every frame, draws `view`, and passes on
// what the subject does. `ready` comes before the training, before the study proper,
// and first of all when a session is resumed; a break lasts at least `rest` ticks. An
// answer counts once the store has it: `answer` returns after that, or the session is
// `unsaved` and goes no further until `retry` succeeds. An abort can so lose only an
// answer that the disk has refused, and it tries once more.
// Thread guarantee: `next_force_N` on the haptics thread, wait-free, no allocation; the rest
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

// What a subject reads before anything else.
std::string study_consent_text(bool strokes);

enum class StudyState : std::uint8_t { consent, ready, presenting, answering, unsaved, rest, done, aborted };

// What to show.
struct StudyView {
  StudyState state = StudyState::consent;
  bool training = false;
  std::size_t answered = 0;   // of this part: training or study
  std::size_t trials = 0;     // of this part
  bool has_reminder = false;  // before the two forces comes one to compare with
  bool reminder = false;      // it is presented now
  int interval = 0;           // 1 or 2 while that force is presented, else 0
  std::uint64_t rest_ticks_left = 0;
  bool has_feedback = false;  // in the training, after an answer
  bool was_correct = false;
  std::string message;  // one or two sentences for the subject
};

class StudySession final : public ForceSource {
 public:
  static constexpr std::uint64_t kRest_ticks = 30000;

  // Takes up where `store` ends. Errors: a code that is none, strokes that do not
  // fill an interval, answers in the store that this plan did not ask for.
  static Result<std::unique_ptr<StudySession>> create(const StudyHeader& header, std::unique_ptr<StudyStore> store,
                                                      std::uint64_t rest_ticks = kRest_ticks);

  // Slow thread. Calls that do not fit the state do nothing.
  void accept_consent(const std::string& when);
  void proceed();            // leaves `ready`, and `rest` when it has lasted
  void update();             // takes in what the ticks did
  void answer(bool second);  // it was the larger, or the one like the reminder
  void retry();              // in `unsaved`
  void abort();

  StudyView view();
  StudyState state() const noexcept { return state_; }
  const StudyHeader& header() const noexcept { return header_; }
  const StudyStore& store() const noexcept { return *store_; }
  // What is being presented or asked about.
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
  std::size_t trained_ = 0;   // trials of the training that are answered
  std::size_t answered_ = 0;  // of the study proper
  StudyTrial trial_;
  StudyRecord record_;  // the answer at hand
  std::uint64_t presentation_ = 0;
  std::uint64_t rest_from_ = 0;
  bool dropped_out_ = false;  // the device, in the last presentation
  std::string problem_;       // why the disk refused
};

}  // namespace palpate
