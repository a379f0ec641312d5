// Which model to take. Chosen on training strokes that were left out of the fits, then
// tested:
//   1. candidates: those with at least 99.9 % of the left-out samples within the JND;
//      all, when none has;
//   2. tied: those whose 95 % interval of the 99th percentile of error/JND overlaps that
//      of the best candidate;
//   3. chosen: the tied one that is cheapest to evaluate, by the distances it takes;
//   4. on the test a choice that fails the 99.9 % while another passes is not
//      recommended: the next tied one that passes is, and that the test had a say is said.
// Thread guarantee: pure functions.
#pragma once

#include "scenes/report/data/report_data.h"

namespace palpate {

inline constexpr double kGoodShare = 0.999;   // within the JND

// How much one evaluation takes, in centres; a corner of a grid's cell counts as one.
int evaluation_cost(const ModelResult& model, std::size_t features);

// From `models[i].left_out` where there are any samples, from the test itself otherwise
// (and says so).
Recommendation recommend(const std::vector<ModelResult>& models, std::size_t features);

// Whether the difference of two models in that figure can be told from chance.
bool tied(const Evidence& one, const Evidence& other);

}  // namespace palpate
