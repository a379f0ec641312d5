#include "scenes/study/psychometrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>

namespace palpate {
namespace {

// The answers that subjects with these slopes give on average, at the study's
// differences.
std::vector<AnswerCell> expected_answers(std::initializer_list<PsychometricFunction> truths, double trials) {
  std::vector<AnswerCell> cells;
  std::size_t reference = 0;
  for (const PsychometricFunction& truth : truths) {
    for (const double difference : {-0.4, -0.3, -0.2, -0.1, 0.1, 0.2, 0.3, 0.4}) {
      for (const bool first : {false, true}) {
        cells.push_back({reference, difference, first, trials * truth.at(difference, first), trials});
      }
    }
    ++reference;
  }
  return cells;
}

TEST(Psychometrics, NormalDistributionMatchesPublishedValues) {
  EXPECT_NEAR(normal_cdf(1.0), 0.8413447460685429, 1e-15);
  EXPECT_NEAR(normal_quantile(0.75), 0.6744897501960817, 1e-14);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-13);
  EXPECT_NEAR(normal_quantile(0.5), 0.0, 1e-15);
}

TEST(Psychometrics, FindsTheFunctionsThatMadeTheAnswers) {
  for (const double lapse : {0.0, 0.02, 0.05}) {
    const auto cells = expected_answers({{2.0, -0.3, lapse}, {5.0, -0.3, lapse}, {12.0, -0.3, lapse}}, 5.0);
    const PsychometricFit fit = fit_psychometric(cells, 3);
    for (std::size_t i = 0; i < 3; ++i) {
      const double slope = i == 0 ? 2.0 : i == 1 ? 5.0 : 12.0;
      EXPECT_NEAR(fit.functions[i].slope, slope, 1e-4 * slope) << lapse;
      EXPECT_NEAR(fit.functions[i].order_bias, -0.3, 1e-4);
      EXPECT_NEAR(fit.functions[i].lapse, lapse, 1e-9);
      EXPECT_TRUE(fit.determined[i]);
    }
  }
}

TEST(Psychometrics, JndIsHalfTheDistanceBetweenTheCriterionPoints) {
  const PsychometricFunction function{5.0, 0.0, 0.0};
  EXPECT_NEAR(function.at(function.jnd(), true), kJndCriterion, 1e-12);
  EXPECT_NEAR(function.at(-function.jnd(), true), 1.0 - kJndCriterion, 1e-12);
}

TEST(Psychometrics, NoOrderBiasIsTakenForAFlatSlope) {
  const PsychometricFunction truth{5.0, 0.8, 0.0};
  const double found = fit_psychometric(expected_answers({truth}, 5.0), 1).functions[0].jnd();
  EXPECT_NEAR(found, truth.jnd(), 1e-5);
}

TEST(Psychometrics, SaysWhichAnswersBoundNothing) {
  // All right, mere guesses, something between, nothing at all.
  std::vector<AnswerCell> cells = expected_answers({{5.0, 0.0, 0.0}}, 5.0);
  for (AnswerCell& cell : cells) cell.judged_larger = std::round(cell.judged_larger);
  for (const double difference : {-0.4, -0.1, 0.1, 0.4}) {
    cells.push_back({1, difference, false, difference > 0.0 ? 10.0 : 0.0, 10.0});
    cells.push_back({2, difference, false, 5.0, 10.0});
  }
  const PsychometricFit fit = fit_psychometric(cells, 4);
  EXPECT_EQ(fit.determined, (std::vector<bool>{true, false, false, false}));
  const std::vector<Estimate> estimates = profile_jnds(cells, fit);
  ASSERT_EQ(estimates.size(), 4u);
  for (const Estimate& estimate : estimates) {
    EXPECT_TRUE(std::isfinite(estimate.low) && std::isfinite(estimate.high));
    EXPECT_LE(estimate.low, estimate.high);
  }
  EXPECT_TRUE(estimates[0].determined);
  EXPECT_FALSE(estimates[1].determined);
  EXPECT_LT(estimates[1].low, 0.02) << "all right: any small JND";
  EXPECT_GT(estimates[1].high, 1.2 * estimates[1].value) << "but not that one alone";
  EXPECT_GT(estimates[2].high, 2.6) << "mere guesses: the largest there is";
}

TEST(Psychometrics, AnswersOfOneKindShareACell) {
  std::vector<AnswerCell> cells;
  add_answers(cells, {0, 0.1, true, 1.0, 1.0});
  add_answers(cells, {0, 0.10005, true, 0.0, 1.0});
  add_answers(cells, {0, 0.1, false, 1.0, 1.0});
  add_answers(cells, {0, 0.102, true, 1.0, 1.0});
  add_answers(cells, {1, 0.1, true, 1.0, 1.0});
  ASSERT_EQ(cells.size(), 4u);
  EXPECT_EQ(cells[0].trials, 2.0);
  EXPECT_EQ(cells[0].judged_larger, 1.0);
}

TEST(Psychometrics, IntervalNarrowsWithTheTrials) {
  double width = 1e9;
  for (const double trials : {5.0, 50.0}) {
    std::vector<AnswerCell> cells = expected_answers({{5.0, 0.0, 0.0}}, trials);
    for (AnswerCell& cell : cells) cell.judged_larger = std::round(cell.judged_larger);
    const PsychometricFit fit = fit_psychometric(cells, 1);
    const Estimate one = profile_jnds(cells, fit)[0];
    EXPECT_LT(one.low, one.value);
    EXPECT_GT(one.high, one.value);
    EXPECT_LT(one.high - one.low, 0.6 * width);
    width = one.high - one.low;
  }
}

// With one reference, answers to one difference as often in either order, and all lapse
// rates but 0 excluded by many right answers, P(larger) alone counts: the ends are where
// the log likelihood ratio of that binomial is 3.84 / 2.
TEST(Psychometrics, IntervalIsThatOfTheLikelihoodRatio) {
  std::vector<AnswerCell> cells;
  for (const bool first : {false, true}) {
    cells.push_back({0, 0.2, first, 80.0, 100.0});
    cells.push_back({0, -0.2, first, 20.0, 100.0});
    cells.push_back({0, 4.0, first, 1e6, 1e6});
    cells.push_back({0, -4.0, first, 0.0, 1e6});
  }
  const Estimate jnd = profile_jnds(cells, fit_psychometric(cells, 1))[0];
  const auto fall = [](double value) {
    const double p = normal_cdf(0.2 * normal_quantile(0.75) / value);
    return 400.0 * (0.8 * std::log(0.8 / p) + 0.2 * std::log(0.2 / (1.0 - p)));
  };
  EXPECT_NEAR(jnd.value, 0.2 * normal_quantile(0.75) / normal_quantile(0.8), 1e-5);
  EXPECT_NEAR(2.0 * fall(jnd.low), 3.841459, 1e-2);
  EXPECT_NEAR(2.0 * fall(jnd.high), 3.841459, 1e-2);
}

TEST(Psychometrics, PercentilesAreCorrectedForBias) {
  std::vector<double> replicates;
  for (int i = 0; i < 999; ++i) replicates.push_back(i);
  const Estimate centred = bias_corrected_interval(499.5, replicates);
  EXPECT_NEAR(centred.low, 24.0, 2.0);
  EXPECT_NEAR(centred.high, 974.0, 2.0);
  // Replicates that come out high say that the estimate does: both ends go down.
  const Estimate shifted = bias_corrected_interval(300.0, replicates);
  EXPECT_LT(shifted.low, centred.low);
  EXPECT_LT(shifted.high, centred.high - 20.0);
}

}  // namespace
}  // namespace palpate
