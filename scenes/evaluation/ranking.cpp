#include "scenes/evaluation/ranking.h"

#include <utility>

namespace palpate {
namespace {

bool better(const Evidence& one, const Evidence& other) {
  return std::pair(one.p99_error_over_jnd, one.rms_error_N) < std::pair(other.p99_error_over_jnd, other.rms_error_N);
}

// No hand tells errors within the JND from each other.
bool unnoticed(const Evidence& evidence) { return evidence.p99_at_most() <= 1.0; }

}  // namespace

Ranking rank(const std::vector<Candidate>& candidates) {
  Ranking ranking;
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    if (better(*candidates[i].evidence, *candidates[ranking.best].evidence)) ranking.best = i;
  }
  ranking.chosen = ranking.best;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Evidence& best = *candidates[ranking.best].evidence;
    const bool tied = paired_difference(*candidates[i].evidence, best).tied();
    if (!tied && !(unnoticed(*candidates[i].evidence) && unnoticed(best))) continue;
    ranking.tied.push_back(i);
    const Candidate& chosen = candidates[ranking.chosen];
    const bool cheaper = candidates[i].cost < chosen.cost;
    const bool equal = candidates[i].cost == chosen.cost;
    if (cheaper || (equal && better(*candidates[i].evidence, *chosen.evidence))) ranking.chosen = i;
  }
  return ranking;
}

}  // namespace palpate
