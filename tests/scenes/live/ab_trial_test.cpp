#include "scenes/live/ab_trial.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace palpate {
namespace {

std::vector<TrialModel> ready() {
  return {{0, "greedy-100", "greedy"}, {1, "kdtree-100", "kdtree"}, {4, "direct", "direct"}, {5, "position only", "position"}};
}

const JndLine kJnd{0.1, 0.0};

TEST(AbTrial, NeedsTwoModels) {
  AbTrial trial(1);
  EXPECT_FALSE(trial.begin({}));
  EXPECT_FALSE(trial.begin({ready()[0]}));
  EXPECT_EQ(trial.state(), AbTrial::State::idle);
  EXPECT_EQ(trial.verdict(), "");
}

TEST(AbTrial, DrawsPairsOrdersAndDifferencesOfBothKinds) {
  AbTrial trial(1), again(1);
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(trial.begin(ready()));
    ASSERT_TRUE(again.begin(ready()));
    const std::pair<std::size_t, std::size_t> pair{trial.slot_under(1), trial.slot_under(2)};
    EXPECT_EQ(pair, std::make_pair(again.slot_under(1), again.slot_under(2))) << "the same seed";
    pairs.insert(pair);
  }
  EXPECT_EQ(pairs, (std::set<std::pair<std::size_t, std::size_t>>{{0, 4}, {4, 0}, {0, 5}, {5, 0}}));
}

TEST(AbTrial, TakesWhatThereIs) {
  AbTrial trial(3);
  const std::vector<TrialModel> two{{2, "a", "random"}, {7, "b", "voxel"}};
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(trial.begin(two));
    EXPECT_EQ(trial.slot_under(1) + trial.slot_under(2), 9u);
  }
}

TEST(AbTrial, PredictsFromTheForcesThatWereMet) {
  AbTrial trial(1);
  ASSERT_TRUE(trial.begin(ready()));
  trial.update(5.0, 1.0, false, kJnd);
  trial.update(std::numeric_limits<double>::quiet_NaN(), 1.0, true, kJnd);
  EXPECT_EQ(trial.largest_over_jnd(), 0.0) << "neither counts";
  for (int i = 0; i < 1000; ++i) trial.update(1.0, 1.0 + (i % 25 == 0 ? 0.3 : 0.05), true, kJnd);
  EXPECT_NEAR(trial.largest_over_jnd(), 3.0, 1e-9);
  EXPECT_NEAR(trial.p95_over_jnd(), 0.5, 0.02) << "4 % are above";
  EXPECT_FALSE(trial.predicts_difference());
  for (int i = 0; i < 100; ++i) trial.update(1.0, 1.3, true, kJnd);
  EXPECT_NEAR(trial.p95_over_jnd(), 3.0, 0.02);
  EXPECT_TRUE(trial.predicts_difference());
  for (int i = 0; i < 1000; ++i) trial.update(1.0, 9.0, true, kJnd);
  EXPECT_LE(trial.p95_over_jnd(), AbTrial::kMostJnd);
}

TEST(AbTrial, TellsTheVerdict) {
  AbTrial trial(1);
  ASSERT_TRUE(trial.begin(ready()));
  EXPECT_EQ(trial.pressed(), 1);
  trial.press(3);
  EXPECT_FALSE(trial.tried_both());
  trial.press(2);
  EXPECT_EQ(trial.pressed(), 2);
  EXPECT_TRUE(trial.tried_both());
  for (int i = 0; i < 100; ++i) trial.update(1.0, 1.25, true, kJnd);
  trial.answer(true);
  EXPECT_EQ(trial.state(), AbTrial::State::answered);
  trial.answer(false);
  EXPECT_TRUE(trial.answered_different()) << "once";
  const std::string verdict = trial.verdict();
  EXPECT_NE(verdict.find("greedy-100"), std::string::npos) << verdict;
  EXPECT_NE(verdict.find("2.5 times what a hand can notice"), std::string::npos) << verdict;
  EXPECT_NE(verdict.find("you said they are different: as predicted."), std::string::npos) << verdict;
  trial.reset();
  EXPECT_EQ(trial.state(), AbTrial::State::idle);
  EXPECT_EQ(trial.largest_over_jnd(), 0.0);
}

TEST(AbTrial, SaysWhenThereWasNothingToCompare) {
  AbTrial trial(1);
  ASSERT_TRUE(trial.begin(ready()));
  trial.answer(false);
  EXPECT_NE(trial.verdict().find("not touched"), std::string::npos);
  ASSERT_TRUE(trial.begin(ready()));
  trial.update(1.0, 1.0, true, kJnd);
  trial.answer(false);
  EXPECT_NE(trial.verdict().find("Only one of them"), std::string::npos);
}

}  // namespace
}  // namespace palpate
