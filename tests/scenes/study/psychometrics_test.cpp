#include "scenes/study/study_analysis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>

namespace palpate {
namespace {

// The expected answers of subjects with these psychometric functions at the
// differences of the study.
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
  EXPECT_NEAR(normal_cdf(kCriterionQuantile), kJndCriterion, 1e-15);
}

TEST(Psychometrics, FindsTheFunctionsThatMadeTheAnswers) {
  for (const double lapse : {0.0, 0.02, 0.05}) {
    const auto cells = expected_answers({{2.0, -0.3, lapse}, {5.0, -0.3, lapse}, {12.0, -0.3, lapse}}, 5.0);
    const auto functions = fit_psychometric(cells, 3);
    for (std::size_t i = 0; i < 3; ++i) {
      const double slope = i == 0 ? 2.0 : i == 1 ? 5.0 : 12.0;
      EXPECT_NEAR(functions[i].slope, slope, 1e-4 * slope) << lapse;
      EXPECT_NEAR(functions[i].order_bias, -0.3, 1e-4);
      EXPECT_NEAR(functions[i].lapse, lapse, 1e-9);
      EXPECT_TRUE(functions[i].determined);
    }
  }
}

TEST(Psychometrics, JndIsHalfTheDistanceBetweenTheCriterionPoints) {
  const PsychometricFunction function{5.0, 0.0, 0.0};
  EXPECT_NEAR(function.at(function.jnd(), true), kJndCriterion, 1e-12);
  EXPECT_NEAR(function.at(-function.jnd(), true), 1.0 - kJndCriterion, 1e-12);
}

TEST(Psychometrics, MarksSlopesThatAnswersDoNotBound) {
  // All correct, guesses, something between, no answers.
  std::vector<AnswerCell> cells = expected_answers({{5.0, 0.0, 0.0}}, 5.0);
  for (AnswerCell& cell : cells) cell.judged_larger = std::round(cell.judged_larger);
  for (const double difference : {-0.4, -0.1, 0.1, 0.4}) {
    cells.push_back({1, difference, false, difference > 0.0 ? 10.0 : 0.0, 10.0});
    cells.push_back({2, difference, false, 5.0, 10.0});
  }
  const auto functions = fit_psychometric(cells, 4);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(functions[i].determined, i == 0) << i;
}

}  // namespace
}  // namespace palpate
