#include "scenes/study/discrimination.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "scenes/study/simulated_subject.h"
#include "tests/support/study_driving.h"

namespace palpate {
namespace {

using test::discrimination_header;
using test::example_strokes;

std::vector<StudyRecord> answers(std::size_t correct, std::size_t trials) {
  std::vector<StudyRecord> records(trials);
  for (std::size_t i = 0; i < trials; ++i) {
    records[i].trial.comparison_first = i % 2 == 0;
    records[i].answered_second = records[i].trial.comparison_first == (i < correct);
  }
  return records;
}

// (p + z^2/2n -+ z sqrt(p(1-p)/n + z^2/4n^2)) / (1 + z^2/n) with z = 1.959964; Brown, Cai &
// DasGupta (2001) tabulate the same.
TEST(Discrimination, IntervalIsWilsons) {
  const ShareInterval half = wilson_interval(50, 100);
  EXPECT_NEAR(half.low, 0.403832, 1e-6);
  EXPECT_NEAR(half.high, 0.596168, 1e-6);
  const double z2 = 1.959964 * 1.959964;
  EXPECT_NEAR(wilson_interval(10, 10).low, 10.0 / (10.0 + z2), 1e-6) << "closed form when all are right";
  EXPECT_EQ(wilson_interval(10, 10).high, 1.0);
  EXPECT_NEAR(wilson_interval(0, 10).high, z2 / (10.0 + z2), 1e-6);
  EXPECT_EQ(wilson_interval(0, 0).high, 1.0);
}

TEST(Discrimination, CountsWhatWasRendered) {
  std::vector<StudyRecord> records = answers(60, 100);
  records[0].training = true;
  records[1].worst_N = 0.033;  // half a JND at no force is 32.5 mN
  records[2].worst_N = 0.032;
  const Discrimination result = discrimination_of("S01", records, *example_strokes(0.9));
  EXPECT_EQ(result.trials, 98u);
  EXPECT_EQ(result.correct, 58u);
  EXPECT_EQ(result.unusable, 1u);
}

TEST(Discrimination, SaysWhetherThePredictionHeld) {
  StrokePair strokes;
  strokes.mean_over_jnd = 0.2;
  strokes.max_over_jnd = 0.71;
  const auto verdict = [&](std::size_t correct) { return discrimination_verdict({"S01", 100, correct, 0}, strokes); };
  EXPECT_EQ(verdict(52),
            "Predicted below the JND (at most 0.71 of it). 52 % right [42 to 62], as by guessing; 75 % would be "
            "one JND: consistent.");
  EXPECT_EQ(verdict(70),
            "Predicted below the JND (at most 0.71 of it). 70 % right [60 to 78], more than by guessing; 75 % "
            "would be one JND: too few answers to tell, the interval holds 75 %.");
  EXPECT_EQ(verdict(97).substr(verdict(97).find("75 % would")), "75 % would be one JND: not consistent.");
  strokes.max_over_jnd = 3.0;
  EXPECT_EQ(verdict(52).substr(0, 70), "Above the JND for a moment only (at most 3.00 of it, on average 0.20).");
  EXPECT_NE(verdict(52).find(": not noticed as one JND would be."), std::string::npos);
  EXPECT_NE(verdict(97).find(": noticed more often than one JND would be."), std::string::npos);
  strokes.mean_over_jnd = 1.5;
  EXPECT_EQ(verdict(97).substr(0, 53), "Predicted above the JND (1.50 of it on average). 97 %");
  EXPECT_NE(verdict(97).find(": consistent."), std::string::npos);
  EXPECT_NE(verdict(52).find(": not consistent."), std::string::npos);
  EXPECT_EQ(discrimination_verdict({"S01", 0, 0, 3}, strokes),
            "Predicted above the JND (1.50 of it on average). No usable answers yet.");
}

TEST(Discrimination, AnalysesFilesOfTheSameStrokesAlone) {
  StudyData one{discrimination_header(0.9), "", answers(60, 100), 0};
  StudyData two = one;
  two.header.subject = "S02";
  two.records = answers(80, 100);
  const auto analysis = analyse_discrimination({one, two});
  ASSERT_TRUE(analysis.ok()) << analysis.error().message;
  EXPECT_EQ(analysis->all.correct, 140u);
  EXPECT_EQ(analysis->all.trials, 200u);
  const std::string table = discrimination_table(*analysis);
  EXPECT_NE(table.find("\nS02,100,80,0,0.8000,0.7112,0.8666,"), std::string::npos) << table;
  EXPECT_EQ(analyse_discrimination({}).error().message, "found no study file, expected one or more");
  EXPECT_EQ(analyse_discrimination({one, one}).error().message,
            "found two files of subject S01, expected one; leave one of them out");
  two.header.strokes = example_strokes(0.8);
  EXPECT_EQ(
      analyse_discrimination({one, two}).error().message,
      "found other strokes in the file of subject S02, expected \"recorded force\" and \"greedy-100\" in silicone 2 "
      "as in the first; analyse them apart");
  two.header = {"S02"};
  EXPECT_EQ(analyse_discrimination({one, two}).error().message,
            "found the procedure constant in the file of subject S02, expected discriminate as in the others; analyse "
            "them apart");
  one.records.clear();
  EXPECT_EQ(analyse_discrimination({one}).error().message, "found no usable answer of subject S01; leave the file out");
}

// The share right of a subject with the JND line `jnd` among `sessions` sessions.
double simulated_share(double stroke_share, const JndLine& jnd, int sessions) {
  const auto strokes = example_strokes(stroke_share);
  double right = 0.0;
  for (int i = 0; i < sessions; ++i) {
    const std::string code = "S" + std::to_string(i + 1);
    const auto records = simulated_answers({code, strokes}, {jnd, 0.0, 0.0}, static_cast<std::uint64_t>(i) + 1);
    right += discrimination_of(code, records, *strokes).share() / sessions;
  }
  return right;
}

// Three standard deviations of 4,000 answers are 0.024 at most.
TEST(Discrimination, SimulatedSubjectsAnswerAsTheirJndSays) {
  const JndLine jnd{0.1, 0.0};
  EXPECT_NEAR(simulated_share(1.0, jnd, 40), 0.5, 0.024) << "the same stroke twice";
  // The largest force that is let through whole is 2 N; noise alike at all forces.
  EXPECT_NEAR(simulated_share(1.0 - 0.1 / 2.0, jnd, 40), 0.75, 0.024) << "one JND there";
  EXPECT_NEAR(simulated_share(1.0 + 0.1 / 2.0, jnd, 40), 0.75, 0.024) << "the larger one";
  EXPECT_GT(simulated_share(0.5, jnd, 5), 0.99) << "grossly different";
}

}  // namespace
}  // namespace palpate
