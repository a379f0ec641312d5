#include "scenes/study/psychometrics.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace palpate {
namespace {

constexpr double kFlattestSlope = 0.25;  // a JND of 2.7 times the reference
constexpr double kSteepestSlope = 40.0;    // of 1.7 %: no difference of the study is as small
constexpr double kPerfect = -0.01;  // log likelihood of answers without one mistake
constexpr double kLargestShift = 5.0;  // of intercept and order bias
constexpr double kLapseStep = 0.01;
constexpr int kLapseSteps = 6;
constexpr int kMostIterations = 60;
constexpr double kConverged = 1e-9;  // of the log likelihood
constexpr double kLeastProbability = 1e-12;

double order_of(bool comparison_first) noexcept { return comparison_first ? -1.0 : 1.0; }

Eigen::Vector3d clamped(Eigen::Vector3d coefficients) noexcept {
  coefficients[0] = std::clamp(coefficients[0], -kLargestShift, kLargestShift);
  coefficients[1] = std::clamp(coefficients[1], kFlattestSlope, kSteepestSlope);
  coefficients[2] = std::clamp(coefficients[2], -kLargestShift, kLargestShift);
  return coefficients;
}

Eigen::Vector3d row_of(const AnswerCell& cell) noexcept {
  return {1.0, cell.difference, order_of(cell.comparison_first)};
}

double probability_at(double z, double lapse) noexcept {
  return std::clamp(lapse + (1.0 - 2.0 * lapse) * normal_cdf(z), kLeastProbability, 1.0 - kLeastProbability);
}

double log_likelihood(const std::vector<AnswerCell>& cells, const Eigen::Vector3d& coefficients, double lapse) {
  double sum = 0.0;
  for (const AnswerCell& cell : cells) {
    const double p = probability_at(row_of(cell).dot(coefficients), lapse);
    if (cell.judged_larger > 0.0) sum += cell.judged_larger * std::log(p);
    if (cell.trials > cell.judged_larger) sum += (cell.trials - cell.judged_larger) * std::log1p(-p);
  }
  return sum;
}

// The step of Fisher scoring: information^-1 x gradient.
Eigen::Vector3d scoring_step(const std::vector<AnswerCell>& cells, const Eigen::Vector3d& coefficients, double lapse) {
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  // A little more than nothing, so that it can be solved without answers too.
  Eigen::Matrix3d information = 1e-9 * Eigen::Matrix3d::Identity();
  for (const AnswerCell& cell : cells) {
    const Eigen::Vector3d row = row_of(cell);
    const double z = row.dot(coefficients);
    const double p = probability_at(z, lapse);
    const double density = (1.0 - 2.0 * lapse) * 0.3989422804014327 * std::exp(-0.5 * z * z);
    const double variance = p * (1.0 - p);
    gradient += row * (density * (cell.judged_larger - cell.trials * p) / variance);
    information += row * row.transpose() * (cell.trials * density * density / variance);
  }
  return information.ldlt().solve(gradient);
}

// Climbs from `start` for one lapse rate; halves a step that does not climb.
double climb(const std::vector<AnswerCell>& cells, double lapse, Eigen::Vector3d& coefficients) {
  double best = log_likelihood(cells, coefficients, lapse);
  for (int i = 0; i < kMostIterations; ++i) {
    Eigen::Vector3d step = scoring_step(cells, coefficients, lapse);
    double reached = best;
    for (int halved = 0; halved < 20; ++halved, step *= 0.5) {
      const Eigen::Vector3d tried = clamped(coefficients + step);
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

// How often the same function answers "larger" in a new run of the cell.
double drawn_answers(double p, double trials, RandomStream& random) noexcept {
  double larger = 0.0;
  for (double trial = 0.5; trial < trials; trial += 1.0) larger += random.uniform(0.0, 1.0) < p ? 1.0 : 0.0;
  return larger;
}

}  // namespace

double normal_cdf(double z) noexcept { return 0.5 * std::erfc(-z * 0.7071067811865476); }

// Bisection, then exact enough for a double: called a few times per fit only.
double normal_quantile(double probability) noexcept {
  double low = -9.0, high = 9.0;
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (normal_cdf(middle) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void add_answer(std::vector<AnswerCell>& cells, double difference, bool comparison_first, bool judged_larger) {
  // As near as a recorded force can tell: 0.1 mN of the smallest reference.
  const auto same = [&](const AnswerCell& cell) {
    return cell.comparison_first == comparison_first && std::abs(cell.difference - difference) < 1e-4;
  };
  auto cell = std::find_if(cells.begin(), cells.end(), same);
  if (cell == cells.end()) cell = cells.insert(cells.end(), {difference, comparison_first, 0.0, 0.0});
  cell->trials += 1.0;
  cell->judged_larger += judged_larger ? 1.0 : 0.0;
}

double PsychometricFunction::at(double difference, bool comparison_first) const noexcept {
  const double z = intercept + slope * difference + order_bias * order_of(comparison_first);
  return lapse + (1.0 - 2.0 * lapse) * normal_cdf(z);
}

PsychometricFit fit_psychometric(const std::vector<AnswerCell>& cells) {
  PsychometricFit fit;
  Eigen::Vector3d coefficients(0.0, 3.0, 0.0);
  for (int i = 0; i <= kLapseSteps; ++i) {
    const double lapse = kLapseStep * i;
    coefficients = clamped(coefficients);
    const double reached = climb(cells, lapse, coefficients);
    if (i > 0 && !(reached > fit.log_likelihood + kConverged)) continue;
    fit.function = {coefficients[0], coefficients[1], coefficients[2], lapse};
    fit.log_likelihood = reached;
  }
  fit.determined = !cells.empty() && fit.function.slope > 1.001 * kFlattestSlope &&
                   fit.function.slope < 0.999 * kSteepestSlope && fit.log_likelihood < kPerfect;
  return fit;
}

Estimate bias_corrected_interval(double value, std::vector<double> replicates, double level) {
  std::sort(replicates.begin(), replicates.end());
  const double count = static_cast<double>(replicates.size());
  const double below = static_cast<double>(std::lower_bound(replicates.begin(), replicates.end(), value) -
                                           replicates.begin());
  const double bias = normal_quantile(std::clamp(below / count, 0.5 / count, 1.0 - 0.5 / count));
  const auto percentile = [&](double share) {
    const double corrected = normal_cdf(2.0 * bias + normal_quantile(share));
    const double place = std::clamp(corrected * (count + 1.0) - 1.0, 0.0, count - 1.0);
    const auto lower = static_cast<std::size_t>(place);
    const std::size_t upper = std::min(lower + 1, replicates.size() - 1);
    return replicates[lower] + (place - static_cast<double>(lower)) * (replicates[upper] - replicates[lower]);
  };
  const double low = percentile(0.5 * (1.0 - level)), high = percentile(0.5 * (1.0 + level));
  return {value, low, high, true};
}

Estimate bootstrap_jnd(const std::vector<AnswerCell>& cells, const PsychometricFit& fit,
                       const BootstrapSettings& settings, RandomStream random) {
  // The JND is this many standard deviations, whatever the fit.
  const double deviations = normal_quantile(settings.criterion);
  std::vector<double> replicates;
  std::vector<AnswerCell> drawn = cells;
  for (int i = 0; i < settings.resamples; ++i) {
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const double p = fit.function.at(cells[c].difference, cells[c].comparison_first);
      drawn[c].judged_larger = drawn_answers(p, cells[c].trials, random);
    }
    replicates.push_back(deviations / fit_psychometric(drawn).function.slope);
  }
  Estimate estimate = bias_corrected_interval(deviations / fit.function.slope, std::move(replicates), settings.level);
  estimate.determined = fit.determined;
  return estimate;
}

}  // namespace palpate
