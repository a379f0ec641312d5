#include "models/samples/cross_validation.h"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace palpate
