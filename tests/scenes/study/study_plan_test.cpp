#include "scenes/study/study_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/support/message_parts.h"

namespace palpate {
namespace {

TEST(StudyPlan, AcceptsCodesAndNoNames) {
  for (const char* code : {"S1", "S01", "AB12", "XYZ9999"}) EXPECT_TRUE(check_subject_code(code).ok()) << code;
  for (const char* name : {"", "Anna", "S", "01", "s01", "S01 ", "ABCD1", "S12345", "S0A", "../S01", "Müller1"}) {
    EXPECT_TRUE(test::has_parts(check_subject_code(name), {std::string("\"") + name + "\"", "such as S01"}));
  }
}

// The trials of the plan after the training trials.
std::vector<StudyTrial> study_trials(const std::string& code, const StrokePair* strokes = nullptr) {
  std::vector<StudyTrial> trials = plan_study(code, strokes);
  std::erase_if(trials, [](const StudyTrial& trial) { return trial.training; });
  return trials;
}

TEST(StudyPlan, PresentsEachPairTenTimesBalancedForOrder) {
  for (const char* code : {"S01", "S02", "AB7"}) {
    const std::vector<StudyTrial> trials = study_trials(code);
    ASSERT_EQ(trials.size(), 320u);
    std::map<std::pair<double, double>, std::pair<int, int>> count;
    for (const StudyTrial& trial : trials) {
      auto& [all, first] = count[{trial.reference_N, trial.comparison_N}];
      ++all;
      first += trial.comparison_first ? 1 : 0;
    }
    ASSERT_EQ(count.size(), 32u);
    for (const auto& [pair, times] : count) {
      EXPECT_EQ(times, (std::pair<int, int>{10, 5})) << pair.first << " " << pair.second;
      EXPECT_GE(pair.second, 0.6 * pair.first - 1e-9);
      EXPECT_LE(pair.second, 1.4 * pair.first + 1e-9);
    }
    // Each pair occurs once in every 32 trials.
    for (std::size_t from = 0; from < 320; from += 32) {
      std::map<std::pair<double, double>, int> round;
      for (std::size_t i = from; i < from + 32; ++i) ++round[{trials[i].reference_N, trials[i].comparison_N}];
      EXPECT_EQ(round.size(), 32u);
    }
  }
}

TEST(StudyPlan, TheOrderDependsOnTheSubjectOnly) {
  EXPECT_EQ(plan_study("S01", nullptr), plan_study("S01", nullptr));
  EXPECT_NE(study_trials("S01"), study_trials("S02"));
  const auto one = plan_study("S01", nullptr), other = plan_study("S02", nullptr);
  ASSERT_TRUE(one[7].training && !one[8].training);
  EXPECT_FALSE(std::equal(one.begin(), one.begin() + 8, other.begin())) << "the training, too";
}

TEST(StudyPlan, DiscriminationsAreBalancedInEveryBlock) {
  StrokePair strokes;
  strokes.reference_mean_N = 1.2;
  strokes.comparison_mean_N = 1.3;
  for (const char* code : {"S01", "S02", "AB1234"}) {
    const std::vector<StudyTrial> trials = study_trials(code, &strokes);
    ASSERT_EQ(trials.size(), kDiscriminationTrials);
    for (std::size_t from = 0; from < trials.size(); from += kDiscriminationBlock) {
      const auto block = trials.begin() + static_cast<std::ptrdiff_t>(from);
      EXPECT_EQ(std::count_if(block, block + kDiscriminationBlock,
                              [](const StudyTrial& trial) { return trial.comparison_first; }),
                static_cast<std::ptrdiff_t>(kDiscriminationBlock / 2));
    }
    EXPECT_EQ(trials[7].reference_N, 1.2);
    EXPECT_EQ(trials[7].comparison_N, 1.3);
    EXPECT_EQ(trials, study_trials(code, &strokes));
  }
  EXPECT_NE(study_trials("S01", &strokes), study_trials("S02", &strokes));
  const auto plan = plan_study("S01", &strokes);
  EXPECT_EQ(plan[3].comparison_N, 0.6);
  EXPECT_TRUE(plan[3].training);
  EXPECT_EQ(plan[3].number, 4u);
  EXPECT_EQ(plan[4].number, 1u);
}

}  // namespace
}  // namespace palpate
