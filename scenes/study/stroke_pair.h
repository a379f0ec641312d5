// One recorded stroke as rendered by two models, or by a model and the recorded force, for a discrimination study.
// Each has one force for each tick of an interval, rounded to 0.1 mN. prepare_strokes.h makes them.
// Thread guarantee: value type.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/tick/jnd.h"

namespace palpate {

struct StrokePair {
  std::string reference;   // "recorded force" or a model's name
  std::string comparison;  // a model's name
  std::string recording;
  double from_s = 0.0;  // in the recording
  double to_s = 0.0;
  std::uint32_t checksum = 0;  // of both forces
  JndLine jnd;
  // |comparison - reference| over the JND of the reference, over the ticks in contact, with the ramps of an interval.
  double mean_over_jnd = 0.0;
  double max_over_jnd = 0.0;
  // Means over the part of the interval without ramps, which represent the strokes in a study file.
  double reference_mean_N = 0.0;
  double comparison_mean_N = 0.0;
  // One force per tick of an interval; empty when the pair was read from a study file.
  std::vector<double> reference_N;
  std::vector<double> comparison_N;
};

// Whether both pairs have the same forces (by checksum) and names.
inline bool same_strokes(const StrokePair& one, const StrokePair& other) {
  return one.checksum == other.checksum && one.reference == other.reference && one.comparison == other.comparison &&
         one.recording == other.recording;
}

}  // namespace palpate
