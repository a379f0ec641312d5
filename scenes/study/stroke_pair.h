// The same recorded stroke as two forces would render it, for a hand to tell apart.
//
// Both are what a still hand is given: one force for each tick of an interval, to
// 0.1 mN. prepare_strokes.h makes them from a recording and models.
// Thread guarantee: a value that does not change; any thread.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/tick/jnd.h"

namespace palpate {

struct StrokePair {
  std::string reference;   // whose force: "recorded force" or a model's name
  std::string comparison;  // likewise
  std::string recording;
  double from_s = 0.0;  // in the recording
  double to_s = 0.0;
  std::uint32_t checksum = 0;  // of both forces
  JndLine jnd;                 // what the error is compared with
  // |comparison - reference| over the JND of the reference, as it is presented, in
  // contact: what the panel and the report show, for this stroke.
  double mean_over_jnd = 0.0;
  double max_over_jnd = 0.0;
  // Means over the held part, which tell the two apart in a file.
  double reference_mean_N = 0.0;
  double comparison_mean_N = 0.0;
  // Of each tick of an interval; empty when all that is known comes from a file.
  std::vector<double> reference_N;
  std::vector<double> comparison_N;
};

// Whether both are of the same forces.
inline bool same_strokes(const StrokePair& one, const StrokePair& other) {
  return one.checksum == other.checksum && one.reference == other.reference && one.comparison == other.comparison &&
         one.recording == other.recording;
}

}  // namespace palpate
