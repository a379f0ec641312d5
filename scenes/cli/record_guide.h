// What to press next while a recording is made: the cells of depth and speed that `check`
// counts, how long was held, how many small strokes there were, and one thing to do.
// Thread guarantee: slow side (reads the file that is being written).
#pragma once

#include <string>
#include <vector>

#include "models/check/check_recording.h"

namespace palpate::cli {

// The next thing to do, from the slow to the fast; empty: nothing is missing.
// `longest_relaxation_s`: of the scene, 0: none.
std::string guide_advice(const RecordingMeasures& measures, double longest_relaxation_s);

// The cells as lines of text, those visited marked.
std::vector<std::string> guide_cells(const RecordingMeasures& measures, double surface_m);

class RecordGuide {
 public:
  RecordGuide(std::string path, const CheckRequest& request);

  // Every two seconds or, when a check takes long, ten times as seldom as it takes: what
  // is new, if anything is. `now_s`: steady clock.
  std::vector<std::string> update(double now_s);

 private:
  std::string path_;
  CheckRequest request_;
  double longest_relaxation_s_ = 0.0;
  double next_s_ = 0.0;
  std::string told_;
};

}  // namespace palpate::cli
