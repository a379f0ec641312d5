// A study session with a device: the haptics loop renders what the session
// presents. No window, no drawing.
//
// Thread guarantee: one thread (the window's) for everything here.
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
  StudyHeader header;  // who, and by which procedure
  std::string path;    // of the answers; taken up where it ends
  bool realtime = true;
};

// Whether this device, as a request names it, renders force: else a study with it is a
// rehearsal. Opens it for a moment. Slow side.
bool study_can_be_felt(const std::string& device);

class LiveStudy {
 public:
  // Errors: the device cannot be opened; the file is in use or of another study; a
  // subject code that is none.
  static Result<std::unique_ptr<LiveStudy>> open(const LiveStudyRequest& request);
  LiveStudy(const LiveStudy&) = delete;
  LiveStudy& operator=(const LiveStudy&) = delete;
  // Lets the force go to zero.
  ~LiveStudy();

  // Once a frame.
  void update();

  StudySession& session() noexcept { return *session_; }
  const LoopSnapshot& newest() const noexcept { return newest_; }
  // Whether a hand can feel it; else this is a rehearsal.
  bool device_pushes() const noexcept { return session_->header().rendered; }
  // What the device needs first, or what it is; may be empty.
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
