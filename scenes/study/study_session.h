// One subject's session: consent, training, trials, breaks, the end. A state machine without window and clock; time is
// counted in ticks of 1 ms. LiveStudy runs it with a device.
//
//   consent -> ready -> presenting -> answering -> presenting ... -> rest -> ... -> done
//   presenting -> ready (the device did not render the planned force; the trial is repeated)
//   any of them -> aborted
//
// The state is `ready` before the training, before the study and when a session is resumed. `answer` stores the answer
// before it returns; if that fails, the session still waits for the answer, and the view says why.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "engine/live/haptics_loop.h"
#include "scenes/study/study_file.h"

namespace palpate {

enum class StudyState : std::uint8_t { consent, ready, presenting, answering, rest, done, aborted };

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

// Thread guarantee: `next_force_N` on the haptics thread, wait-free, no allocation; the rest on one slow thread.
class StudySession final : public ForceSource {
 public:
  static constexpr std::uint64_t kRest_ticks = 30000;

  // Resumes after the last answer in `file`. A break lasts at least `rest_ticks`.
  explicit StudySession(StudyFile file, std::uint64_t rest_ticks = kRest_ticks);

  // Calls that do not fit the state have no effect.
  void accept_consent(const std::string& when);
  void proceed();            // leaves `ready`, and `rest` after `rest_ticks`
  void update();             // processes the ticks since the last call; in every frame
  void answer(bool second);  // whether the second was the larger, or like the reminder
  void abort();              // from any state except `done`

  StudyView view();
  StudyState state() const noexcept { return state_; }
  const StudyFile& file() const noexcept { return file_; }
  const StudyTrial& trial() const { return trials_.at(answered()); }  // the current one

  double next_force_N(double rendered_N) noexcept override { return presenter_.tick(rendered_N); }

 private:
  std::size_t answered() const noexcept { return file_.records().size(); }
  const StrokePair* strokes() const noexcept { return file_.header().strokes.get(); }
  std::string message(const StudyView& view) const;
  void present_next();

  StudyFile file_;
  std::uint64_t rest_ticks_;
  std::vector<StudyTrial> trials_;
  StudyPresenter presenter_;

  StudyState state_ = StudyState::consent;
  std::uint64_t presentation_ = 0, rest_until_ = 0;
  bool dropped_out_ = false;  // the device did not render the last presentation as planned
  std::string problem_;       // error message of the file
};

// A device, and the haptics loop that renders the forces of a session. One thread (the window's).
class LiveStudy {
 public:
  // `strokes`: null for constant stimuli. Errors: the device cannot be opened.
  static Result<std::unique_ptr<LiveStudy>> open(const std::string& device, bool realtime, StrokesPointer strokes);
  // Ramps the force to zero.
  ~LiveStudy();

  // Creates or resumes study-CODE.csv, or with strokes discriminate-CODE.csv, in the working directory. Call it once,
  // or again after an error. Errors: those of StudyFile::open; a thread cannot be started.
  Status begin(const std::string& code);
  void update();

  // Null before `begin` succeeded.
  StudySession* session() noexcept { return loop_ != nullptr ? session_.get() : nullptr; }
  const StrokePair* strokes() const noexcept { return header_.strokes.get(); }
  // Whether the device renders force to a person; else this is a rehearsal.
  bool device_pushes() const noexcept { return header_.rendered; }
  // In words: a fault of the device, else the next step of its zeroing, else its note; may be empty.
  std::string device_words() const;
  bool needs_zeroing() const noexcept { return newest_.device.zeroing == Zeroing::needed; }
  void start_zeroing() { device_->start_zeroing(); }

 private:
  LiveStudy() = default;

  bool realtime_ = true;
  StudyHeader header_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<StudySession> session_;
  std::unique_ptr<HapticsLoop> loop_;
  LoopSnapshot newest_;
};

}  // namespace palpate
