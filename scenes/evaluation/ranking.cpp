#include "scenes/evaluation/ranking.h"

#include <algorithm>
#include <string_view>
#include <tuple>

#include "models/correction/methods.h"

namespace palpate {
namespace {

// The place of the method in the order of simplicity: the trend, then the table of methods from its end. One that is
// not listed is the least simple.
std::ptrdiff_t complexity(std::string_view method) {
  const std::string_view corrects = method.substr(method.rfind('+') + 1);
  if (corrects == kTrendMethod.name) return -1;
  return std::ranges::find(methods().rbegin(), methods().rend(), corrects, &Method::name) - methods().rbegin();
}

}  // namespace

Ranking rank(const std::vector<Candidate>& candidates) {
  Ranking ranking;
  const auto best = std::ranges::min_element(candidates, {}, &Candidate::p99_error_over_jnd);
  ranking.best = static_cast<std::size_t>(best - candidates.begin());
  double shortest_ns = best->tick_ns;
  for (const Candidate& one : candidates) {
    ranking.near_best.push_back(one.p99_error_over_jnd <= best->p99_error_over_jnd + kMargin_jnd);
    if (ranking.near_best.back()) shortest_ns = std::min(shortest_ns, one.tick_ns);
  }
  ranking.recommended = ranking.best;
  const auto order = [&](std::size_t i) {
    const Candidate& one = candidates[i];
    const bool fast = ranking.near_best[i] && one.tick_ns <= (1.0 + kEqualTime) * shortest_ns;
    return std::tuple(!fast, complexity(one.method), one.p99_error_over_jnd);
  };
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (order(i) < order(ranking.recommended)) ranking.recommended = i;
  }
  return ranking;
}

}  // namespace palpate
