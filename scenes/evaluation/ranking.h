// Recommends one of several models that were evaluated on the same samples: non-inferiority test, then time.
//   best         the model with the smallest 99 % error
//   qualified    non-inferior to the best: the one-sided 95 % bound of the difference of the errors, paired by unit,
//                is at most kMargin_jnd. With too few units for a bound, the difference itself is at most that.
//   recommended  the fastest qualified model. Where the interval of a time overlaps that of the fastest, the
//                smaller error decides. A model that dominates the result (smaller error, less time) replaces it.
// The report, the window and the front page use this rule.
// Source: Piaggio et al. (2012), JAMA 308, for non-inferiority.
// Thread guarantee: pure functions.
#pragma once

#include <cstddef>
#include <vector>

#include "scenes/evaluation/model_errors.h"
#include "scenes/evaluation/model_timing.h"

namespace palpate {

// One JND is the difference at which 75 % of forced choices between two forces are correct: z(0.75) = 0.674 standard
// deviations of the psychometric function. At a quarter of it Phi(0.25 x 0.674) = 57 % are correct; chance is 50 %.
inline constexpr double kMargin_jnd = 0.25;

struct Candidate {
  UnitErrors errors;  // every candidate has the same units
  Timing tick;
};

struct Ranking {
  std::size_t best = 0;
  std::size_t recommended = 0;
  std::vector<bool> qualified;  // for each candidate; true for `best` and `recommended`
};

// `candidates`: at least one, each with samples. `best` and `recommended` are indices of `candidates`.
Ranking rank(const std::vector<Candidate>& candidates);

// Whether `one` has the smaller error and a time whose whole interval is below that of `other`.
bool dominates(const Candidate& one, const Candidate& other);

}  // namespace palpate
