// Advice on what to press next during a recording: that of the findings of `check` (models/check/check_recording.h) on
// coverage and holds, and small strokes.
// Thread guarantee: slow side (reads the file that is being written).
#pragma once

#include <string>
#include <vector>

#include "models/check/check_recording.h"

namespace palpate::cli {

class RecordGuide {
 public:
  RecordGuide(std::string path, const CheckRequest& request);

  // Checks the file every two seconds, or less often so that checks take at most a tenth of the time. Returns the
  // lines to print, none when nothing has changed. `now_s`: steady clock.
  std::vector<std::string> update(double now_s);

 private:
  std::vector<std::string> advice() const;

  std::string path_;
  CheckRequest request_;
  double next_s_ = 0.0;
  std::vector<std::string> printed_;
};

}  // namespace palpate::cli
