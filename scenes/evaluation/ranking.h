// Which model to take, of some that were evaluated over the same samples:
//   best     the smallest 99 % error; of equal ones the smallest RMS
//   tied     those that cannot be told from the best: their paired difference not from 0, or
//            both not by a hand, the 99 % errors being within the JND (95 %, one-sided)
//   chosen   the tied one that is cheapest to evaluate
// Thread guarantee: pure functions.
#pragma once

#include <cstddef>
#include <vector>

#include "scenes/evaluation/model_errors.h"

namespace palpate {

struct Candidate {
  const Evidence* evidence = nullptr;
  int cost = 0;  // what one evaluation takes, in distances; 0 for a trend alone
};

struct Ranking {
  std::size_t best = 0;
  std::size_t chosen = 0;
  std::vector<std::size_t> tied;  // the best and the chosen among them, in the order given
};

// `candidates`: one at least, all with samples.
Ranking rank(const std::vector<Candidate>& candidates);

}  // namespace palpate
