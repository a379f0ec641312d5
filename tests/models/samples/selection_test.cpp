#include "models/samples/selection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace palpate {
namespace {

TEST(DeepestElsewhere, IsTheGreatestDepthOfTheOtherFolds) {
  const std::vector<int> fold{0, 1, 2, 0};
  const std::vector<double> depth_m{1.0, 5.0, 2.0, 3.0};
  EXPECT_EQ(deepest_elsewhere_m(fold, depth_m, 3), (std::vector{5.0, 3.0, 5.0}));
}

// Mean squared errors, in JND^2, of 100 samples in each fold.
FoldErrors errors_of(std::vector<double> means) {
  FoldErrors errors(means.size());
  for (std::size_t k = 0; k < means.size(); ++k) {
    for (int i = 0; i < 100; ++i) errors.add(k, std::sqrt(means[k]));
  }
  return errors;
}

std::size_t selected(std::vector<FoldErrors> candidates) { return simplest_adequate(candidates); }

TEST(Selection, ASignificantGainInEveryFoldIsTaken) {
  EXPECT_EQ(selected({errors_of({10, 12, 11, 13, 9}), errors_of({9, 11, 10, 12, 8})}), 1u);
}

TEST(Selection, AGainInOneFoldAloneIsNot) {
  EXPECT_EQ(selected({errors_of({10, 12, 11, 13, 9}), errors_of({1, 12, 11, 13, 9})}), 0u);
}

TEST(Selection, AFoldThatIsHardForEveryCandidateDoesNotOutvoteTheOthers) {
  EXPECT_EQ(selected({errors_of({470, 102, 51.6, 3.57, 5.5}), errors_of({18.7, 3.07, 0.59, 0.4, 0.37})}), 1u);
}

TEST(Selection, ErrorsThatAHandCannotNoticeDoNotCount) {
  EXPECT_EQ(best_score(std::vector{errors_of({4.0, 1e-3}), errors_of({1.0, 2e-3})}), 1u);
}

// Candidates with other corrections of the recordings have other samples. The third fold of the first is empty.
TEST(Selection, AFoldThatOneCandidateLacksCountsForNone) {
  FoldErrors lacking(3);
  for (const std::size_t fold : {0u, 1u}) lacking.add(fold, 3.0);
  EXPECT_EQ(selected({lacking, errors_of({9, 9, 0})}), 0u);
  EXPECT_EQ(selected({lacking, errors_of({1, 1, 100})}), 1u);
  EXPECT_EQ(selected({FoldErrors(3), errors_of({1, 1, 1})}), 0u);
}

TEST(Selection, TheRootMeanSquareIsOverAllSamples) {
  EXPECT_NEAR(errors_of({4.0, 1.0}).rms(), std::sqrt(2.5), 1e-12);
  EXPECT_EQ(FoldErrors(3).rms(), 0.0);
}

// For equal folds it equals their RMS. A fold with large errors counts by its logarithm.
TEST(Selection, TheTypicalErrorIsThatOfTheMeanScore) {
  EXPECT_NEAR(errors_of({4.0, 4.0}).rms_at_mean_score(), 2.0, 1e-12);
  EXPECT_EQ(errors_of({0.0, 0.0}).rms_at_mean_score(), 0.0);
  EXPECT_LT(errors_of({100.0, 1.0}).rms_at_mean_score(), 0.5 * errors_of({100.0, 1.0}).rms());
  EXPECT_EQ(FoldErrors(3).rms_at_mean_score(), 0.0);
}

const SearchRange kRange{-10.0, 10.0, 0.5, 1e-3, 1.0};

// Ten blocks, each a parabola with its minimum near `at`.
BlockCosts bowl(double x, double at, double floor) {
  BlockCosts costs;
  for (int b = 0; b < 10; ++b) costs.push_back(floor + (x - at - 0.02 * (b - 4.5)) * (x - at - 0.02 * (b - 4.5)));
  return costs;
}

TEST(ProfileSearch, FindsTheOffsetThatAllBlocksAgreeOn) {
  const OffsetEstimate found = estimate_offset([](double x) { return bowl(x, 7.3, 0.01); }, kRange);
  EXPECT_TRUE(found.identified);
  EXPECT_NEAR(found.at, 7.3, 0.01);
  EXPECT_LT(found.standard_error, 0.2);
}

TEST(ProfileSearch, ZeroStandsWhileItIsAsGood) {
  const OffsetEstimate found = estimate_offset([](double x) { return bowl(x, 0.03, 1.0); }, kRange);
  EXPECT_TRUE(found.identified);
  EXPECT_EQ(found.at, 0.0);
}

// If the material can imitate an offset, all blocks have the same error. The jackknife gives
// 0.05 +- 0.02, but the cost is not significantly lower than at 0.
TEST(ProfileSearch, AnOffsetThatTheMaterialImitatesIsNotIdentified) {
  SearchRange with_effect = kRange;
  with_effect.systematic_effect = 0.3;
  const OffsetEstimate found = estimate_offset([](double x) { return bowl(x, 0.05, 1.0); }, with_effect);
  EXPECT_FALSE(found.identified);
  EXPECT_EQ(found.at, 0.0);
  EXPECT_NEAR(estimate_offset([](double x) { return bowl(x, 7.3, 0.01); }, with_effect).at, 7.3, 0.01);
}

TEST(ProfileSearch, ABlurIsPartOfTheError) {
  SearchRange with_effect = kRange;
  with_effect.systematic_effect = 1.0;
  const auto at = [&](double place) {
    return estimate_offset([=](double x) { return bowl(x, place, 0.01); }, with_effect);
  };
  EXPECT_EQ(at(0.9).at, 0.0);
  EXPECT_NEAR(at(3.0).at, 3.0, 0.01);
  EXPECT_GE(at(3.0).standard_error, 0.5);
}

TEST(ProfileSearch, AnEdgeTwoMinimaOrOneBlockIdentifyNothing) {
  const auto edge = [](double x) { return bowl(x, 14.0, 0.01); };
  const auto two = [](double x) { return bowl(std::abs(x), 5.0, 0.01); };
  const auto lone = [](double x) {
    BlockCosts costs(10, 1.0);
    costs[3] += (x - 5.0) * (x - 5.0);
    return costs;
  };
  for (const std::function<BlockCosts(double)>& cost : {std::function<BlockCosts(double)>(edge), {two}, {lone}}) {
    const OffsetEstimate found = estimate_offset(cost, kRange);
    EXPECT_FALSE(found.identified);
    EXPECT_EQ(found.at, 0.0);
  }
  EXPECT_TRUE(estimate_offset(two, kRange).not_zero);
}

// Regression: a gap of hours made all costs NaN, and the search ended the program.
TEST(ProfileSearch, EndsWhateverTheCostFunctionReturns) {
  const double nan = std::nan("");
  const double infinity = std::numeric_limits<double>::infinity();
  for (const BlockCosts& costs : {BlockCosts(10, nan), BlockCosts(10, infinity), BlockCosts(10, -infinity),
                                  BlockCosts(10, 1e308), BlockCosts(10, 0.0), BlockCosts{}}) {
    const OffsetEstimate found = estimate_offset([&](double) { return costs; }, kRange);
    EXPECT_FALSE(found.identified);
    EXPECT_EQ(found.at, 0.0);
  }
}

TEST(ProfileSearch, APlaceWithoutACostIsNoMinimum) {
  const auto holes = [&](double x) { return std::abs(x) < 1.0 ? BlockCosts(10, std::nan("")) : bowl(x, 7.3, 0.01); };
  EXPECT_NEAR(estimate_offset(holes, kRange).at, 7.3, 0.01);
}

TEST(ProfileSearch, WithoutARangeNothingIsTold) {
  const auto any = [](double x) { return bowl(x, 1.0, 0.01); };
  for (const SearchRange& range : {SearchRange{1.0, 1.0, 0.5, 1e-3, 1.0}, SearchRange{2.0, -2.0, 0.5, 1e-3, 1.0},
                                   SearchRange{-1.0, 1.0, 0.0, 1e-3, 1.0}, SearchRange{std::nan(""), 1.0, 0.1, 1e-3}}) {
    EXPECT_FALSE(estimate_offset(any, range).identified);
  }
}

// A linear spring: a surface offset of 1 equals a force offset of 3.
TEST(ProfileSearch, WhatAForceOffsetExplainsAsWellIsNotTold) {
  const OffsetEstimate shift = estimate_offset([](double x) { return bowl(x, 1.0, 0.01); }, kRange);
  ASSERT_TRUE(shift.identified);
  const OffsetEstimate both = unless_force_offset(
      shift, [](double f_N) { return bowl(f_N / 3.0, 1.0, 0.01); }, 10.0);
  EXPECT_FALSE(both.identified);
  EXPECT_EQ(both.at, 0.0);
  EXPECT_NEAR(both.minimum_at, 1.0, 0.01);
  EXPECT_NEAR(both.force_offset_N, 3.0, 0.05);
  const OffsetEstimate only = unless_force_offset(
      shift, [](double f_N) { return bowl(f_N / 3.0, 1.0, 9.0); }, 10.0);
  EXPECT_TRUE(only.identified);
  EXPECT_EQ(only.at, shift.at);
  EXPECT_EQ(only.force_offset_N, 0.0);
}

}  // namespace
}  // namespace palpate
