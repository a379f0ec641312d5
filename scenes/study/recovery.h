// Does the study find what is there? Simulated subjects whose JND is known go through
// it, and the estimates are held against the truth.
//
// The subjects differ: JND lines from 0.03 to 0.065 N plus 5 to 12 %, order bias within
// half a JND, lapse rates up to 3 %.
// Deterministic. Thread guarantee: slow side; uses all cores.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "scenes/study/psychometrics.h"
#include "scenes/study/study_procedure.h"
#include "scenes/study/study_store.h"

namespace palpate {

struct RecoverySettings {
  ProcedureKind procedure = ProcedureKind::constant;
  int subjects = 200;
  std::uint64_t seed = 1;
  StudyTiming timing;
  IntervalSettings intervals;
};

// One reference force.
struct RecoveryRow {
  double reference_N = 0.0;
  int subjects = 0;
  int determined = 0;
  double coverage = 0.0;          // share of the intervals that hold the truth
  double median_ratio = 0.0;      // estimate / truth
  double rms_log_error = 0.0;     // of the determined: typical error as a factor e^x
  double median_high_over_low = 0.0;  // how wide the intervals are
};

// `progress` gets the share done, and ends it by false ("interrupted"). Errors: as
// StudySession::create.
Result<std::vector<RecoveryRow>> measure_recovery(const RecoverySettings& settings,
                                                  const std::function<bool(double)>& progress);

}  // namespace palpate
