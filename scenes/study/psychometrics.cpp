#include "scenes/study/psychometrics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate {
namespace {

constexpr double kFlattestSlope = 0.25;
constexpr double kSteepestSlope = 40.0;
constexpr double kLargestBias = 3.0;
constexpr double kLapseStep = 0.01;
constexpr int kLapseSteps = 6;
constexpr double kConverged = 1e-9;  // of the log likelihood
// The answers bound a slope if the log likelihood at both ends of the range is lower than at the fit by at least this,
// which is a likelihood ratio of 1.1.
constexpr double kNoticeablyWorse = 0.1;
constexpr double kLeastProbability = 1e-12;

using Cells = std::vector<AnswerCell>;

// The argument at which `function`, with one maximum between `low` and `high`, is largest, to 1e-7: golden-section
// search (Kiefer 1953).
template <typename Function>
double maximum_between(double low, double high, const Function& function) {
  double best = high - (high - low) / std::numbers::phi, at_best = function(best);
  while (high - low > 1e-7) {
    const double other = low + high - best, at_other = function(other);
    ((other < best) == (at_other > at_best) ? high : low) = at_other > at_best ? best : other;
    if (at_other > at_best) {
      best = other;
      at_best = at_other;
    }
  }
  return 0.5 * (low + high);
}

double log_likelihood(const Cells& cells, const PsychometricFunction& function) {
  double sum = 0.0;
  for (const AnswerCell& cell : cells) {
    const double p =
        std::clamp(function.at(cell.difference, cell.comparison_first), kLeastProbability, 1.0 - kLeastProbability);
    sum += cell.judged_larger * std::log(p) + (cell.trials - cell.judged_larger) * std::log1p(-p);
  }
  return sum;
}

// The function of one reference force with the most likely slope.
PsychometricFunction with_best_slope(const Cells& cells, PsychometricFunction function) {
  function.slope = std::exp(maximum_between(std::log(kFlattestSlope), std::log(kSteepestSlope), [&](double log_slope) {
    function.slope = std::exp(log_slope);
    return log_likelihood(cells, function);
  }));
  return function;
}

bool bounds_slope(const Cells& cells, const PsychometricFunction& fitted) {
  const double limit = log_likelihood(cells, fitted) - kNoticeablyWorse;
  PsychometricFunction flattest = fitted, steepest = fitted;
  flattest.slope = kFlattestSlope;
  steepest.slope = kSteepestSlope;
  return log_likelihood(cells, flattest) < limit && log_likelihood(cells, steepest) < limit;
}

}  // namespace

double normal_cdf(double z) noexcept { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double PsychometricFunction::at(double difference, bool comparison_first) const noexcept {
  return lapse + (1.0 - 2.0 * lapse) * normal_cdf(slope * difference + (comparison_first ? -order_bias : order_bias));
}

// For a given bias and lapse rate the reference forces are independent, so that the likelihood is maximised by nested
// searches: over the lapse rate, the bias, and the slope of each reference force.
std::vector<PsychometricFunction> fit_psychometric(const Cells& cells, std::size_t references) {
  std::vector<Cells> of_reference(references);
  for (const AnswerCell& cell : cells) of_reference[cell.reference].push_back(cell);
  PsychometricFunction shared;
  const auto best_at = [&](double bias) {
    shared.order_bias = bias;
    double sum = 0.0;
    for (const Cells& own : of_reference) sum += log_likelihood(own, with_best_slope(own, shared));
    return sum;
  };
  PsychometricFunction best;
  double most_likely = 0.0;
  for (int i = 0; i <= kLapseSteps; ++i) {
    shared.lapse = kLapseStep * i;
    const double reached = best_at(maximum_between(-kLargestBias, kLargestBias, best_at));
    if (i > 0 && !(reached > most_likely + kConverged)) break;  // the likelihood has one maximum over the lapse rate
    most_likely = reached;
    best = shared;
  }
  std::vector<PsychometricFunction> functions;
  for (const Cells& own : of_reference) {
    functions.push_back(with_best_slope(own, best));
    functions.back().determined = bounds_slope(own, functions.back());
  }
  return functions;
}

}  // namespace palpate
