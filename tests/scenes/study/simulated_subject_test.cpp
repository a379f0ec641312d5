#include "scenes/study/simulated_subject.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

double share_of_second(const SubjectTraits& traits, double first_N, double second_N) {
  RandomStream random(3, 31);
  int second = 0;
  for (int i = 0; i < 20000; ++i) second += second_feels_larger(traits, first_N, second_N, random) ? 1 : 0;
  return second / 20000.0;
}

// Three standard deviations of 20,000 draws are 0.011 at most.
TEST(SimulatedSubject, DiscriminatesForcesByItsJnd) {
  const SubjectTraits traits{{0.065, 0.0633}, 0.0, 0.0};
  for (const double reference_N : {0.3, 2.5}) {
    EXPECT_NEAR(share_of_second(traits, reference_N, reference_N), 0.5, 0.011);
    // Slightly less than 0.75, because the larger force has larger noise.
    EXPECT_NEAR(share_of_second(traits, reference_N, reference_N + traits.jnd.at(reference_N)), 0.75, 0.017);
  }
}

TEST(SimulatedSubject, HasBiasAndLapses) {
  EXPECT_NEAR(share_of_second({{0.1, 0.0}, 1.0, 0.0}, 1.0, 1.0), 0.75, 0.011) << "one JND for the second";
  EXPECT_NEAR(share_of_second({{0.01, 0.0}, 0.0, 0.05}, 1.0, 2.0), 0.95, 0.011);
}

TEST(SimulatedSubject, GivesAllAnswersOfAPlanAndRepeatsThem) {
  const auto one = simulated_answers({"S01"}, {}, 7);
  EXPECT_EQ(one.size(), 328u);
  EXPECT_EQ(one, simulated_answers({"S01"}, {}, 7));
  EXPECT_NE(one, simulated_answers({"S01"}, {}, 8));
}

}  // namespace
}  // namespace palpate
