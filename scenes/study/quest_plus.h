// QUEST+: which difference to ask about next, and what the answers say so far.
//
// Source: A. B. Watson (2017), "QUEST+: A general multidimensional Bayesian
// adaptive psychometric method", Journal of Vision 17(3):10. The stimulus is the
// one whose answer is expected to tell most about the parameters: the expected
// entropy of the posterior is least, which is the same as
//   h(sum w p) - sum w h(p)   being largest,
// w the posterior over the parameters, p their probabilities of the answer
// "comparison larger", h the entropy of a yes or no.
//
// One reference force. With x the difference relative to it and o = +1 when the
// comparison comes second, -1 when first:
//   p = lapse + (1 - 2 lapse) Phi(x / sigma + order_bias o)
// Prior: flat in the logarithm of sigma from 0.03 to 2, order bias -0.6 .. 0.6,
// lapse 0, 0.02 or 0.05.
// Thread guarantee: one thread; slow side (tens of microseconds).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "scenes/study/psychometrics.h"

namespace palpate {

class QuestPlus {
 public:
  QuestPlus();

  // The magnitude of the difference to present, relative to the reference, one of
  // 0.025, 0.05 .. 0.4; side and order are given.
  double next_difference(bool comparison_larger, bool comparison_first) const;

  // `difference`: (comparison - reference) / reference as it was presented.
  void answered(double difference, bool comparison_first, bool comparison_judged_larger);

  // The JND relative to the reference at `criterion` (see psychometrics.h): the
  // median of the posterior and the interval between its quantiles (1 - level) / 2
  // and (1 + level) / 2. level: 0 .. 1.
  Estimate relative_jnd(double criterion, double level) const;

 private:
  double quantile(double share) const;  // of sigma
  std::vector<double> weights_;         // of each parameter combination, sum 1
};

}  // namespace palpate
