// A study with a device, without a window: the haptics loop renders the forces of a session.
// Thread guarantee: one thread (the window's).
#pragma once

#include <memory>
#include <string>

#include "engine/base/result.h"
#include "engine/live/haptics_loop.h"
#include "scenes/study/study_session.h"

namespace palpate {

class LiveStudy {
 public:
  // `strokes`: null for constant stimuli. Errors: the device cannot be opened.
  static Result<std::unique_ptr<LiveStudy>> open(const std::string& device, bool realtime,
                                                 std::shared_ptr<const StrokePair> strokes);
  LiveStudy(const LiveStudy&) = delete;
  LiveStudy& operator=(const LiveStudy&) = delete;
  // Ramps the force to zero.
  ~LiveStudy();

  // Creates or resumes study-CODE.csv, or with strokes discriminate-CODE.csv, in the working directory. Once; again
  // after an error. Errors: the file is in use or of another study; an invalid code; no thread.
  Status begin(const std::string& code);
  // Call it once a frame.
  void update();

  // Null before `begin` succeeded.
  StudySession* session() noexcept { return loop_ != nullptr ? session_.get() : nullptr; }
  const StrokePair* strokes() const noexcept { return header_.strokes.get(); }
  // Whether the device renders force to a person; else this is a rehearsal.
  bool device_pushes() const noexcept { return header_.rendered; }
  // A fault of the device, else the next step of its zeroing, else its note; may be empty.
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
