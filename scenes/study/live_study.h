// A study session with a device, without a window: the haptics loop renders the forces of the session.
// Thread guarantee: one thread (the window's).
#pragma once

#include <memory>
#include <string>

#include "engine/base/result.h"
#include "engine/live/haptics_loop.h"
#include "scenes/study/study_session.h"

namespace palpate {

inline constexpr const char* kRehearsal =
    "No force device: nobody can feel anything. This is a rehearsal; its answers are marked so and left out of the "
    "analysis.";

struct LiveStudyRequest {
  std::string device = "auto";
  StudyHeader header;  // subject and procedure
  std::string path;    // of the study file; an existing one is resumed
  bool realtime = true;
};

// Whether the device renders force to a person; else a study with it is a rehearsal. Opens and closes the device;
// slow side.
bool study_can_be_felt(const std::string& device);

class LiveStudy {
 public:
  // Errors: the device cannot be opened; the file is in use or of another study; an invalid subject code; no thread.
  static Result<std::unique_ptr<LiveStudy>> open(const LiveStudyRequest& request);
  LiveStudy(const LiveStudy&) = delete;
  LiveStudy& operator=(const LiveStudy&) = delete;
  // Ramps the force to zero.
  ~LiveStudy();

  // Call it once a frame.
  void update();

  StudySession& session() noexcept { return *session_; }
  const LoopSnapshot& newest() const noexcept { return newest_; }
  // Whether the device renders force to a person; else this is a rehearsal.
  bool device_pushes() const noexcept { return session_->header().rendered; }
  // A fault of the device, else the next step of its zeroing, else its note; may be empty.
  std::string device_words() const;
  void start_zeroing() { device_->start_zeroing(); }

 private:
  LiveStudy(std::unique_ptr<Device> device, std::unique_ptr<StudySession> session);

  std::unique_ptr<Device> device_;
  std::unique_ptr<StudySession> session_;
  std::unique_ptr<HapticsLoop> loop_;
  LoopSnapshot newest_;
};

}  // namespace palpate
