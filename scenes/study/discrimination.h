// Could they tell the two strokes apart, and was that to be expected?
//
// Of n answers k are right; chance is one half.
//   interval   of the share right, by E. B. Wilson (1927), Journal of the American
//              Statistical Association 22, 209-212
// One JND is kJndCriterion, 75 % right. So the strokes were below the JND when the whole
// interval lies below 75 %, above it when the whole lies above, and else there are too
// few answers to say. The prediction is "below" when the error is nowhere more than one
// JND, "above" when it is more than one on average, else none: how much a short moment
// counts, the JND does not say.
// Training does not count, nor do trials in which the force was at any tick further from
// what it should be than half a JND at no force: those were other strokes.
// Thread guarantee: pure functions; slow side.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "scenes/study/study_file.h"

namespace palpate {

struct Discrimination {
  std::string subject;  // "all": of everybody
  std::size_t trials = 0;
  std::size_t correct = 0;
  std::size_t unusable = 0;  // trials

  double share() const noexcept;  // 0 without trials
};

struct ShareInterval {
  double low = 0.0;
  double high = 1.0;
};
// `correct` of `trials`; 95 %. Without trials 0 to 1.
ShareInterval wilson_interval(std::size_t correct, std::size_t trials) noexcept;

Discrimination discrimination_of(const std::string& subject, const std::vector<StudyRecord>& records,
                                 const StrokePair& strokes);

// What was predicted, what came out, and whether that agrees, in plain words; e.g.
// "Predicted below the JND (at most 0.71 of it). 52 % right [42 to 62], as by guessing;
// 75 % would be one JND: consistent."
std::string discrimination_verdict(const Discrimination& result, const StrokePair& strokes);

struct DiscriminationAnalysis {
  std::shared_ptr<const StrokePair> strokes;
  std::vector<Discrimination> subjects;
  Discrimination all;  // answers of all together
};

// Errors: no file; a file of another procedure; strokes that are not the same in all; a
// subject twice, or without usable answers.
Result<DiscriminationAnalysis> analyse_discrimination(const std::vector<StudyData>& files);

// One row per subject, then all: CSV with a header row.
std::string discrimination_table(const DiscriminationAnalysis& analysis);

}  // namespace palpate
