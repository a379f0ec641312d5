// The stretch of a recording in which a model is worst.
//
// Thread guarantee: pure function, slow side.
#pragma once

#include <string>
#include <vector>

#include "engine/recording/recording.h"
#include "scenes/evaluation/evaluate.h"

namespace palpate {

inline constexpr double kStretchSeconds = 5.0;

struct StretchRow {
  double time_s = 0.0;
  double measured_N = 0.0;
  bool in_contact = false;
  std::vector<double> force_N;  // of the models, in their order
};

struct WorstStretch {
  std::string recording;
  double score = -1.0;  // mean squared error over the JND of the first model
  std::vector<StretchRow> rows;
  std::vector<std::string> models;  // names
};

// The kStretchSeconds with the largest mean squared error/JND of the first of `models` over
// the samples in contact; the whole of a shorter recording. Up to kMaxModels models.
// What came before `from_s` is replayed, but does not count.
WorstStretch worst_stretch(const Recording& recording, const std::vector<ModelPointer>& models, const JndLine& jnd,
                           double from_s = -1e300);

}  // namespace palpate
