#include "scenes/study/psychometrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>

namespace palpate {
namespace {

// The answers that `truth` gives on average, at the study's differences.
std::vector<AnswerCell> expected_answers(const PsychometricFunction& truth, double trials) {
  std::vector<AnswerCell> cells;
  for (const double difference : {-0.4, -0.3, -0.2, -0.1, 0.1, 0.2, 0.3, 0.4}) {
    for (const bool first : {false, true}) {
      cells.push_back({difference, first, trials * truth.at(difference, first), trials});
    }
  }
  return cells;
}

TEST(Psychometrics, NormalDistributionMatchesPublishedValues) {
  EXPECT_NEAR(normal_cdf(1.0), 0.8413447460685429, 1e-15);
  EXPECT_NEAR(normal_quantile(0.75), 0.6744897501960817, 1e-14);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-13);
  EXPECT_NEAR(normal_quantile(0.5), 0.0, 1e-15);
}

TEST(Psychometrics, FindsTheFunctionThatMadeTheAnswers) {
  for (const double slope : {2.0, 5.0, 12.0}) {
    for (const double lapse : {0.0, 0.02, 0.05}) {
      const PsychometricFunction truth{0.2, slope, -0.3, lapse};
      const PsychometricFit fit = fit_psychometric(expected_answers(truth, 5.0));
      EXPECT_NEAR(fit.function.slope, slope, 2e-3 * slope) << slope << " " << lapse;
      EXPECT_NEAR(fit.function.intercept, 0.2, 2e-3);
      EXPECT_NEAR(fit.function.order_bias, -0.3, 2e-3);
      EXPECT_NEAR(fit.function.lapse, lapse, 1e-9);
      EXPECT_TRUE(fit.determined);
    }
  }
}

TEST(Psychometrics, JndIsHalfTheDistanceBetweenTheCriterionPoints) {
  const PsychometricFunction function{0.4, 5.0, 0.0, 0.0};
  for (const double criterion : {0.75, 0.84}) {
    const double jnd = function.jnd(criterion);
    const double middle = -0.4 / 5.0;
    EXPECT_NEAR(function.at(middle + jnd, true), criterion, 1e-12);
    EXPECT_NEAR(function.at(middle - jnd, true), 1.0 - criterion, 1e-12);
  }
}

TEST(Psychometrics, NoOrderBiasIsTakenForAFlatSlope) {
  const PsychometricFunction truth{0.0, 5.0, 0.8, 0.0};
  const double found = fit_psychometric(expected_answers(truth, 5.0)).function.jnd(kJndCriterion);
  EXPECT_NEAR(found, truth.jnd(kJndCriterion), 1e-4);
}

TEST(Psychometrics, SaysWhenTheAnswersBoundNothing) {
  std::vector<AnswerCell> right, guessed;
  for (const double difference : {-0.4, -0.1, 0.1, 0.4}) {
    right.push_back({difference, false, difference > 0.0 ? 10.0 : 0.0, 10.0});
    guessed.push_back({difference, false, 5.0, 10.0});
  }
  EXPECT_FALSE(fit_psychometric(right).determined);
  EXPECT_FALSE(fit_psychometric(guessed).determined);
  EXPECT_FALSE(fit_psychometric({}).determined);
  for (const auto* cells : {&right, &guessed}) {
    const Estimate estimate = bootstrap_jnd(*cells, fit_psychometric(*cells), {0.75, 0.95, 50}, RandomStream(1, 1));
    EXPECT_FALSE(estimate.determined);
    EXPECT_TRUE(std::isfinite(estimate.low) && std::isfinite(estimate.high));
  }
}

TEST(Psychometrics, AnswersOfOneKindShareACell) {
  std::vector<AnswerCell> cells;
  add_answer(cells, 0.1, true, true);
  add_answer(cells, 0.10005, true, false);
  add_answer(cells, 0.1, false, true);
  add_answer(cells, 0.102, true, true);
  ASSERT_EQ(cells.size(), 3u);
  EXPECT_EQ(cells[0].trials, 2.0);
  EXPECT_EQ(cells[0].judged_larger, 1.0);
}

TEST(Psychometrics, IntervalNarrowsWithTheTrialsAndRepeats) {
  const PsychometricFunction truth{0.0, 5.0, 0.0, 0.0};
  double width = 1e9;
  for (const double trials : {5.0, 50.0}) {
    std::vector<AnswerCell> cells = expected_answers(truth, trials);
    for (AnswerCell& cell : cells) cell.judged_larger = std::round(cell.judged_larger);
    const PsychometricFit fit = fit_psychometric(cells);
    const Estimate one = bootstrap_jnd(cells, fit, {0.75, 0.95, 200}, RandomStream(7, 1));
    const Estimate again = bootstrap_jnd(cells, fit, {0.75, 0.95, 200}, RandomStream(7, 1));
    EXPECT_EQ(one.low, again.low);
    EXPECT_LT(one.low, one.value);
    EXPECT_GT(one.high, one.value);
    EXPECT_LT(one.high - one.low, 0.6 * width);
    width = one.high - one.low;
  }
}

TEST(Psychometrics, PercentilesAreCorrectedForBias) {
  std::vector<double> replicates;
  for (int i = 0; i < 999; ++i) replicates.push_back(i);
  const Estimate centred = bias_corrected_interval(499.5, replicates, 0.95);
  EXPECT_NEAR(centred.low, 24.0, 2.0);
  EXPECT_NEAR(centred.high, 974.0, 2.0);
  // Replicates that come out high say that the estimate does: both ends go down.
  const Estimate shifted = bias_corrected_interval(300.0, replicates, 0.95);
  EXPECT_LT(shifted.low, centred.low);
  EXPECT_LT(shifted.high, centred.high - 20.0);
}

}  // namespace
}  // namespace palpate
