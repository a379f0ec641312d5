#include "scenes/report/measure/recommendation.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

Evidence evidence(double within, double p99, double half_width) {
  Evidence result;
  result.samples = 1000;
  result.within_jnd = within;
  result.p99_error_over_jnd = p99;
  result.p99_interval = {p99 - half_width, p99 + half_width};
  return result;
}

ModelResult model(const Method& method, int size, const Evidence& left_out, const Evidence& test) {
  ModelResult result;
  result.plan.request.method = &method;
  result.plan.rung = Rung::palpate;
  result.plan.name = std::string(method.name) + "-" + std::to_string(size);
  result.size = size;
  result.left_out = left_out;
  result.pooled = test;
  return result;
}

TEST(Recommendation, IsTheCheapestOfTheTied) {
  const Evidence good = evidence(1.0, 0.5, 0.01);
  const Recommendation choice = recommend({model(kGreedyMethod, 200, evidence(1.0, 0.50, 0.1), good),
                                           model(kGreedyMethod, 50, evidence(1.0, 0.60, 0.1), good),
                                           model(kRandomMethod, 10, evidence(1.0, 0.90, 0.1), good)}, 4);
  EXPECT_EQ(choice.recommended, "greedy-50");
  EXPECT_EQ(choice.tied, (std::vector<std::string>{"greedy-50", "greedy-200"}));
  EXPECT_TRUE(choice.left_out);
}

TEST(Recommendation, IsMadeWithoutTheTest) {
  // On the test the other one is better, by luck: the choice stays.
  const Recommendation choice = recommend({model(kGreedyMethod, 100, evidence(1.0, 0.5, 0.01), evidence(0.9995, 0.9, 0.01)),
                                           model(kKdTreeMethod, 100, evidence(1.0, 0.7, 0.01), evidence(1.0, 0.4, 0.01))}, 4);
  EXPECT_EQ(choice.recommended, "greedy-100");
}

TEST(Recommendation, NeverNamesAModelThatFailsWhileAnotherPasses) {
  const Recommendation choice = recommend({model(kKdTreeMethod, 50, evidence(1.0, 0.5, 0.01), evidence(0.9962, 1.3, 0.1)),
                                           model(kGreedyMethod, 100, evidence(1.0, 0.6, 0.01), evidence(1.0, 0.8, 0.1))}, 4);
  EXPECT_EQ(choice.chosen, "kdtree-50");
  EXPECT_EQ(choice.recommended, "greedy-100");
  EXPECT_NE(choice.reason.find("It failed its test: 99.62 % of the test within the JND"), std::string::npos) << choice.reason;
  EXPECT_NE(choice.reason.find("the test had a say in that"), std::string::npos);
}

TEST(Recommendation, SaysWhenNoneReachesTheMark) {
  const Recommendation choice =
      recommend({model(kGreedyMethod, 100, evidence(0.95, 2.0, 0.1), evidence(0.96, 2.0, 0.1))}, 4);
  EXPECT_EQ(choice.recommended, "greedy-100");
  EXPECT_NE(choice.reason.find("no model of this report reaches 99.9 %"), std::string::npos);
}

TEST(Recommendation, SaysWhenNothingCouldBeLeftOut) {
  const Recommendation choice = recommend({model(kGreedyMethod, 100, {}, evidence(1.0, 0.5, 0.1))}, 4);
  EXPECT_FALSE(choice.left_out);
  EXPECT_NE(choice.reason.find("no test remains that had no say"), std::string::npos);
}

TEST(Recommendation, AGridCostsTheCornersOfACell) {
  EXPECT_EQ(evaluation_cost(model(kVoxelMethod, 33275, {}, {}), 4), 16);
  EXPECT_EQ(evaluation_cost(model(kGreedyMethod, 100, {}, {}), 4), 100);
}

}  // namespace
}  // namespace palpate
