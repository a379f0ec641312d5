#include "scenes/evaluation/ranking.h"

#include <algorithm>

namespace palpate {
namespace {

bool faster(const Timing& one, const Timing& other) { return one.high_ns < other.low_ns; }

bool is_non_inferior(const Candidate& one, const Candidate& best) {
  const PairedDifference difference =
      paired_difference(one.error_over_jnd, one.unit_errors_over_jnd, best.error_over_jnd, best.unit_errors_over_jnd);
  return (std::isfinite(difference.at_most) ? difference.at_most : difference.p99) <= kMargin_jnd;
}

}  // namespace

Candidate candidate(const UnitErrors& errors, const ModelTiming& time) {
  return {errors.p99_error_over_jnd, errors.unit_p99, time.tick};
}

bool dominates(const Candidate& one, const Candidate& other) {
  return one.error_over_jnd < other.error_over_jnd && faster(one.tick, other.tick);
}

Ranking rank(const std::vector<Candidate>& candidates) {
  const auto smaller_error = [&](std::size_t a, std::size_t b) {
    return candidates[a].error_over_jnd < candidates[b].error_over_jnd;
  };
  Ranking ranking;
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    if (smaller_error(i, ranking.best)) ranking.best = i;
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (i == ranking.best || is_non_inferior(candidates[i], candidates[ranking.best])) ranking.qualified.push_back(i);
  }
  const std::size_t fastest = *std::min_element(
      ranking.qualified.begin(), ranking.qualified.end(),
      [&](std::size_t a, std::size_t b) { return candidates[a].tick.median_ns < candidates[b].tick.median_ns; });
  ranking.recommended = fastest;
  for (const std::size_t i : ranking.qualified) {
    const bool equal = !faster(candidates[fastest].tick, candidates[i].tick);
    if (equal && smaller_error(i, ranking.recommended)) ranking.recommended = i;
  }
  // A model whose error is uncertain may fail the test of non-inferiority and yet dominate the recommended one.
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!dominates(candidates[i], candidates[ranking.recommended])) continue;
    ranking.recommended = i;
    i = static_cast<std::size_t>(-1);  // starts again; this ends, because each error is smaller than the last
  }
  if (std::find(ranking.qualified.begin(), ranking.qualified.end(), ranking.recommended) == ranking.qualified.end()) {
    ranking.qualified.push_back(ranking.recommended);
    std::sort(ranking.qualified.begin(), ranking.qualified.end());
  }
  return ranking;
}

}  // namespace palpate
