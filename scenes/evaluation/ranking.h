// Which model to recommend, of some that were evaluated over the same samples: non-inferiority, then time.
//   best         the smallest 99 % error
//   qualified    the one-sided 95 % bound of its error less the best's, paired by unit, is at most
//                kMargin_jnd; where there are too few units for a bound the difference itself is
//   recommended  of the qualified the one with the least measured time; times whose intervals overlap are equal,
//                and of equal ones the smallest error counts
//   never one that another model beats in both time and error.
// The one rule of the report, the window and the front page.
// Source: Piaggio et al. (2012), JAMA 308, for non-inferiority.
// Thread guarantee: pure functions.
#pragma once

#include <cstddef>
#include <vector>

#include "scenes/evaluation/model_errors.h"
#include "scenes/evaluation/model_timing.h"

namespace palpate {

// One JND is what 75 % of forced choices between two forces get right, z(0.75) = 0.674 standard deviations of the
// psychometric function. A difference of a quarter of it is right in Phi(0.25 x 0.674) = 57 % of the choices, where
// guessing has 50.
inline constexpr double kMargin_jnd = 0.25;

struct Candidate {
  double error_over_jnd = 0.0;               // 99 % error, over all samples
  std::vector<double> unit_errors_over_jnd;  // of each unit, the same units for every candidate
  Timing tick;
};
Candidate candidate(const Evidence& errors, const ModelTiming& time);

struct Ranking {
  std::size_t best = 0;
  std::size_t recommended = 0;
  std::vector<std::size_t> qualified;  // best and recommended among them, in the order given
};

// `candidates`: one at least, all with samples.
Ranking rank(const std::vector<Candidate>& candidates);

// Smaller error, and a time whose interval is below: the other one is never recommended.
bool dominates(const Candidate& one, const Candidate& other);

}  // namespace palpate
