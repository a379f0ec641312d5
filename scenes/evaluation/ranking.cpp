#include "scenes/evaluation/ranking.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <tuple>

namespace palpate {
namespace {

// The place of the method in the order of simplicity; one that is not listed is the least simple.
std::ptrdiff_t complexity(std::string_view method) {
  constexpr std::array<std::string_view, 6> kSimplestFirst{"trend", "greedy", "kdtree", "random", "voxel", "direct"};
  const std::string_view corrects = method.substr(method.rfind('+') + 1);
  return std::ranges::find(kSimplestFirst, corrects) - kSimplestFirst.begin();
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
