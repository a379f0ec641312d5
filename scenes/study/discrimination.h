// Analysis of the discrimination of two strokes: share of correct answers, and agreement with the predicted error.
// Chance is 50 %. The interval of the share correct is that of E. B. Wilson (1927), Journal of the American
// Statistical Association 22, 209-212. One JND is kJndCriterion, 75 % correct: the strokes differ by less than the JND
// when the whole interval is below 75 %, by more when it is above; else there are too few answers. The prediction is
// "below" when the error nowhere exceeds one JND, "above" when its mean does, else none, because the JND does not
// determine how much a short difference counts.
// Excluded are training, rehearsals, and trials in which the rendered force deviated at any tick from the stroke by
// more than half the JND at 0 N.
// Thread guarantee: pure functions; slow side.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "scenes/study/study_file.h"

namespace palpate {

struct Discrimination {
  std::string subject;  // "all": all subjects together
  std::size_t trials = 0;
  std::size_t correct = 0;
  std::size_t unusable = 0;  // excluded trials

  double share() const noexcept;  // 0 without trials
};

struct ShareInterval {
  double low = 0.0;
  double high = 1.0;
};
// 95 % interval of the share correct. Without trials 0 to 1.
ShareInterval wilson_interval(std::size_t correct, std::size_t trials) noexcept;

Discrimination discrimination_of(const std::string& subject, const std::vector<StudyRecord>& records,
                                 const StrokePair& strokes);

// Prediction, result and their agreement in words, e.g.
// "Predicted below the JND (at most 0.71 of it). 52 % right [42 to 62], as by guessing;
// 75 % would be one JND: consistent."
std::string discrimination_verdict(const Discrimination& result, const StrokePair& strokes);

// The result of each subject, then of all answers together. Errors: those of check_study_files; a file of constant
// stimuli; a subject without usable answers.
Result<std::vector<Discrimination>> analyse_discrimination(const std::vector<StudyData>& files);

// One row per result: CSV with a header row.
std::string discrimination_table(const std::vector<Discrimination>& results, const StrokePair& strokes);

}  // namespace palpate
