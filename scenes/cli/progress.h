// How far a long job is, on stderr when that is a terminal, and whether the
// user wants it to stop.
//
// Thread guarantee: one thread.
#pragma once

#include <chrono>
#include <string>

#include "engine/base/signals.h"

namespace palpate::cli {

// While one exists, the first Ctrl-C (SIGINT), SIGTERM or SIGHUP asks the job to stop instead of ending the
// program, so that it can tidy up; the second ends it (signals.h). One at a time.
class ProgressLine {
 public:
  explicit ProgressLine(std::string label);
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine();  // clears the line

  // `fraction` done, 0..1. Returns false once the user interrupted: stop, leave no file.
  bool update(double fraction);

 private:
  using Clock = std::chrono::steady_clock;
  void draw(double fraction, Clock::time_point now);

  StopListener listener_;
  std::string label_;
  Clock::time_point start_;
  Clock::time_point last_drawn_;
  bool terminal_;
  bool drawn_ = false;
};

// "label  37 %  12 s left"; the remaining time appears once it can be guessed (2 % and 1 s).
std::string progress_text(const std::string& label, double fraction, double elapsed_s);

}  // namespace palpate::cli
