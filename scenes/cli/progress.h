// Progress of a long job on stderr, if that is a terminal, and the user's request to stop.
// Thread guarantee: one thread.
#pragma once

#include <chrono>
#include <string>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/base/signals.h"

namespace palpate::cli {

// While a ProgressLine exists, the first Ctrl-C (SIGINT), SIGTERM or SIGHUP requests a stop instead of ending the
// program; the second ends it (signals.h). There may be only one at a time.
class ProgressLine {
 public:
  explicit ProgressLine(std::string label);
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine();  // clears the line

  // `fraction`: the share done, 0..1; a smaller one than before is drawn as before. Returns false after an interrupt:
  // then end the job without a file.
  bool update(double fraction);

 private:
  using Clock = std::chrono::steady_clock;

  StopListener listener_;
  std::string label_;
  Clock::time_point start_;
  Clock::time_point last_drawn_;
  bool terminal_, drawn_ = false;
  double most_ = 0.0;  // of the fractions
};

// For processes of which another one shows the progress: no line is drawn any more.
void hide_progress();

// Calls `make` with the progress on stderr.
auto with_progress(std::string label, const auto& make) {
  ProgressLine line(std::move(label));
  return make(FitControl{[&](double fraction) { return line.update(fraction); }});
}

// "label  37 %  12 s left"; the remaining time is shown after 2 % and 1 s.
std::string progress_text(const std::string& label, double fraction, double elapsed_s);

}  // namespace palpate::cli
