#include "scenes/evaluation/ranking.h"

#include <algorithm>

namespace palpate {
namespace {

bool faster(const Timing& one, const Timing& other) { return one.high_ns < other.low_ns; }

bool smaller_error(const Candidate& one, const Candidate& other) {
  return one.errors.p99_error_over_jnd < other.errors.p99_error_over_jnd;
}

bool is_non_inferior(const Candidate& one, const Candidate& best) {
  const PairedDifference difference = paired_difference(one.errors, best.errors);
  return (std::isfinite(difference.at_most) ? difference.at_most : difference.p99) <= kMargin_jnd;
}

}  // namespace

bool dominates(const Candidate& one, const Candidate& other) {
  return smaller_error(one, other) && faster(one.tick, other.tick);
}

Ranking rank(const std::vector<Candidate>& candidates) {
  Ranking ranking;
  const auto best = std::min_element(candidates.begin(), candidates.end(), smaller_error);
  ranking.best = static_cast<std::size_t>(best - candidates.begin());
  std::size_t fastest = ranking.best;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    ranking.qualified.push_back(i == ranking.best || is_non_inferior(candidates[i], *best));
    if (ranking.qualified[i] && candidates[i].tick.median_ns < candidates[fastest].tick.median_ns) fastest = i;
  }
  ranking.recommended = fastest;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool equal = ranking.qualified[i] && !faster(candidates[fastest].tick, candidates[i].tick);
    if (equal && smaller_error(candidates[i], candidates[ranking.recommended])) ranking.recommended = i;
  }
  // A model whose error is uncertain may fail the test of non-inferiority and yet dominate the recommended one. One
  // pass is enough, because dominance is transitive.
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (dominates(candidates[i], candidates[ranking.recommended])) ranking.recommended = i;
  }
  ranking.qualified[ranking.recommended] = true;
  return ranking;
}

}  // namespace palpate
