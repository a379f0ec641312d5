// Advice on what to press next during a recording, by the measures of `check` (recording_measures.h): the coverage of
// cells of depth and speed, the longest hold, and the number of small strokes.
// Thread guarantee: slow side (reads the file that is being written).
#pragma once

#include <string>
#include <vector>

#include "models/check/check_recording.h"

namespace palpate::cli {

// Advice on the next press: slow presses first, then fast ones, a hold, small strokes. Empty: nothing is missing.
// `longest_relaxation_s`: the longest relaxation time of the scene, s; 0: none.
std::string guide_advice(const RecordingMeasures& measures, double longest_relaxation_s);

// The table of cells of depth and speed as lines of text, with the seconds in each. `surface_m`: position of depth 0.
std::vector<std::string> guide_cells(const RecordingMeasures& measures, double surface_m);

class RecordGuide {
 public:
  RecordGuide(std::string path, const CheckRequest& request);

  // Checks the file every two seconds, or less often so that checks take at most a tenth of the time. Returns the
  // lines to print, none when nothing has changed. `now_s`: steady clock.
  std::vector<std::string> update(double now_s);

 private:
  std::string path_;
  CheckRequest request_;
  double next_s_ = 0.0;
  std::string printed_;  // the last advice and cells
};

}  // namespace palpate::cli
