// QUEST+: which difference to ask about next, and what the answers say so far.
//
// Source: A. B. Watson (2017), "QUEST+: A general multidimensional Bayesian
// adaptive psychometric method", Journal of Vision 17(3):10. The stimulus is the
// one whose answer is expected to leave the least entropy. What is not wanted, order
// bias and lapse rate, is integrated out first, after N. Prins (2013), "The psi-marginal
// adaptive method", Journal of Vision 13(7):3; with w the posterior over what is wanted
// and p the probability of the answer "comparison larger" given that,
//   h(sum w p) - sum w h(p)
// is largest, h the entropy of a yes or no.
//
// The model is that of psychometrics.h with the JND as a line over the reference force,
//   JND(F) = offset + weber_fraction F,   neither of them negative,
// so that the answers at all references determine two numbers: this is what makes 80
// trials do. (With a JND of its own for each reference, 20 answers each, the intervals
// spanned a factor of 9, not 3.) Prior: flat in the logarithms of the JNDs at 0.3 N (5 %
// to 120 %) and 2.5 N (4 %, well below what was ever published, to 60 %); order bias
// -0.6 .. 0.6, lapse 0, 0.02 or 0.05.
// Thread guarantee: one thread; slow side (a millisecond).
#pragma once

#include <cstddef>
#include <vector>

#include "scenes/study/psychometrics.h"

namespace palpate {

class QuestPlus {
 public:
  QuestPlus();

  // The magnitude of the difference to present next, relative to the reference force,
  // one of 0.025, 0.05 .. 0.4; side and order are given. `reference`: which of
  // kReferenceForces_N.
  double next_difference(std::size_t reference, bool comparison_larger, bool comparison_first) const;

  // `difference`: (comparison - reference) / reference as it was presented.
  void answered(std::size_t reference, double difference, bool comparison_first, bool comparison_judged_larger);

  // The JND relative to the reference at `criterion` (see psychometrics.h): the
  // median of the posterior and the interval between its quantiles (1 - level) / 2
  // and (1 + level) / 2. level: 0 .. 1.
  Estimate relative_jnd(std::size_t reference, double criterion, double level) const;

 private:
  std::vector<double> weights_;  // of each parameter combination, sum 1
};

}  // namespace palpate
