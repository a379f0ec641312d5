#include "scenes/study/psychometrics.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace palpate {
namespace {

constexpr double kFlattestSlope = 0.25;  // a JND of 2.7 times the reference
constexpr double kSteepestSlope = 40.0;  // a JND of 1.7 %; all differences in the study are larger
constexpr double kLargestBias = 3.0;
constexpr double kLapseStep = 0.01;
constexpr int kLapseSteps = 6;
constexpr int kMostIterations = 60;
constexpr double kConverged = 1e-9;  // of the log likelihood
// The answers bound a slope if the log likelihood at both ends of the range is lower than at the fit by at least this,
// which is a likelihood ratio of 1.1.
constexpr double kNoticeablyWorse = 0.1;
constexpr double kLeastProbability = 1e-12;

// The slopes, then the order bias, without heap memory.
constexpr int kMostCoefficients = static_cast<int>(kMostReferences) + 1;
using Coefficients = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostCoefficients, 1>;
using Information = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostCoefficients, kMostCoefficients>;

double order_of(bool comparison_first) noexcept { return comparison_first ? -1.0 : 1.0; }

double least(Eigen::Index i, Eigen::Index last) { return i < last ? kFlattestSlope : -kLargestBias; }
double most(Eigen::Index i, Eigen::Index last) { return i < last ? kSteepestSlope : kLargestBias; }

Coefficients clamped(Coefficients coefficients) {
  const Eigen::Index last = coefficients.size() - 1;
  for (Eigen::Index i = 0; i <= last; ++i) coefficients[i] = std::clamp(coefficients[i], least(i, last), most(i, last));
  return coefficients;
}

double z_of(const AnswerCell& cell, const Coefficients& coefficients) {
  return coefficients[static_cast<Eigen::Index>(cell.reference)] * cell.difference +
         coefficients[coefficients.size() - 1] * order_of(cell.comparison_first);
}

double probability_at(double z, double lapse) noexcept {
  return std::clamp(lapse + (1.0 - 2.0 * lapse) * normal_cdf(z), kLeastProbability, 1.0 - kLeastProbability);
}

double log_likelihood(const AnswerCell& cell, double z, double lapse) {
  const double p = probability_at(z, lapse);
  double sum = 0.0;
  if (cell.judged_larger > 0.0) sum += cell.judged_larger * std::log(p);
  if (cell.trials > cell.judged_larger) sum += (cell.trials - cell.judged_larger) * std::log1p(-p);
  return sum;
}

double log_likelihood(const std::vector<AnswerCell>& cells, const Coefficients& coefficients, double lapse) {
  double sum = 0.0;
  for (const AnswerCell& cell : cells) sum += log_likelihood(cell, z_of(cell, coefficients), lapse);
  return sum;
}

// The step of Fisher scoring: information^-1 x gradient. A coefficient at the end of its range that would leave it is
// kept constant.
Coefficients scoring_step(const std::vector<AnswerCell>& cells, const Coefficients& coefficients, double lapse) {
  const Eigen::Index last = coefficients.size() - 1;
  Coefficients gradient = Coefficients::Zero(last + 1);
  // A small ridge, so that the system can be solved without answers.
  Information information = 1e-9 * Information::Identity(last + 1, last + 1);
  for (const AnswerCell& cell : cells) {
    const double z = z_of(cell, coefficients);
    const double p = probability_at(z, lapse);
    const double density = (1.0 - 2.0 * lapse) * 0.3989422804014327 * std::exp(-0.5 * z * z);
    const double pull = density * (cell.judged_larger - cell.trials * p) / (p * (1.0 - p));
    const double weight = cell.trials * density * density / (p * (1.0 - p));
    const auto i = static_cast<Eigen::Index>(cell.reference);
    const double order = order_of(cell.comparison_first);
    gradient[i] += pull * cell.difference;
    gradient[last] += pull * order;
    information(i, i) += weight * cell.difference * cell.difference;
    information(last, last) += weight;
    information(i, last) += weight * cell.difference * order;
    information(last, i) = information(i, last);
  }
  for (Eigen::Index i = 0; i <= last; ++i) {
    const bool leaves = (coefficients[i] >= most(i, last) && gradient[i] > 0.0) ||
                        (coefficients[i] <= least(i, last) && gradient[i] < 0.0);
    if (!leaves) continue;
    information.row(i).setZero();
    information.col(i).setZero();
    information(i, i) = 1.0;
    gradient[i] = 0.0;
  }
  return information.ldlt().solve(gradient);
}

// Maximises the log likelihood for one lapse rate from `coefficients`; halves a step that does not increase it.
double climb(const std::vector<AnswerCell>& cells, double lapse, Coefficients& coefficients) {
  double best = log_likelihood(cells, coefficients, lapse);
  for (int i = 0; i < kMostIterations; ++i) {
    Coefficients step = scoring_step(cells, coefficients, lapse);
    double reached = best;
    for (int halved = 0; halved < 20; ++halved, step *= 0.5) {
      const Coefficients tried = clamped(coefficients + step);
      const double there = log_likelihood(cells, tried, lapse);
      if (!(there > best)) continue;
      coefficients = tried;
      reached = there;
      break;
    }
    if (reached - best < kConverged) return reached;
    best = reached;
  }
  return best;
}

// Whether the answers bound the slope (kNoticeablyWorse).
bool bounds_slope(const std::vector<AnswerCell>& cells, std::size_t reference, const PsychometricFunction& fitted) {
  double at_fit = 0.0, at_flattest = 0.0, at_steepest = 0.0;
  for (const AnswerCell& cell : cells) {
    if (cell.reference != reference) continue;
    const double bias = fitted.order_bias * order_of(cell.comparison_first);
    at_fit += log_likelihood(cell, fitted.slope * cell.difference + bias, fitted.lapse);
    at_flattest += log_likelihood(cell, kFlattestSlope * cell.difference + bias, fitted.lapse);
    at_steepest += log_likelihood(cell, kSteepestSlope * cell.difference + bias, fitted.lapse);
  }
  return at_fit > at_flattest + kNoticeablyWorse && at_fit > at_steepest + kNoticeablyWorse;
}

}  // namespace

double normal_cdf(double z) noexcept { return 0.5 * std::erfc(-z * 0.7071067811865476); }

// Bisection to the precision of a double. It is slow, and called a few times per fit only.
double normal_quantile(double probability) noexcept {
  double low = -9.0, high = 9.0;
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (normal_cdf(middle) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void add_answers(std::vector<AnswerCell>& cells, const AnswerCell& answers) {
  // Equal within the resolution of a recorded force: 0.1 mN over the smallest reference.
  const auto same = [&](const AnswerCell& cell) {
    return cell.reference == answers.reference && cell.comparison_first == answers.comparison_first &&
           std::abs(cell.difference - answers.difference) < 1e-4;
  };
  const auto cell = std::find_if(cells.begin(), cells.end(), same);
  if (cell == cells.end()) {
    cells.push_back(answers);
    return;
  }
  cell->trials += answers.trials;
  cell->judged_larger += answers.judged_larger;
}

double PsychometricFunction::at(double difference, bool comparison_first) const noexcept {
  const double z = slope * difference + order_bias * order_of(comparison_first);
  return lapse + (1.0 - 2.0 * lapse) * normal_cdf(z);
}

PsychometricFit fit_psychometric(const std::vector<AnswerCell>& cells, std::size_t references) {
  const auto last = static_cast<Eigen::Index>(references);
  Coefficients coefficients = Coefficients::Constant(last + 1, 4.0);
  coefficients[last] = 0.0;
  Coefficients best = coefficients;
  double most_likely = 0.0, best_lapse = 0.0;
  for (int i = 0; i <= kLapseSteps; ++i) {
    const double lapse = kLapseStep * i;
    const double reached = climb(cells, lapse, coefficients);
    if (i > 0 && !(reached > most_likely + kConverged)) break;  // the likelihood has one maximum over the lapse rate
    most_likely = reached;
    best = coefficients;
    best_lapse = lapse;
  }
  PsychometricFit fit;
  for (std::size_t i = 0; i < references; ++i) {
    fit.functions.push_back({best[static_cast<Eigen::Index>(i)], best[last], best_lapse});
    fit.determined.push_back(bounds_slope(cells, i, fit.functions.back()));
  }
  return fit;
}

}  // namespace palpate
