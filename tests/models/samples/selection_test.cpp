#include "models/samples/selection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace palpate {
namespace {

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
