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
  records[0].trial.training = true;
  records[1].worst_N = 0.033;  // half a JND at 0 N is 32.5 mN
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
  const auto expect = [&](std::size_t correct, const std::string& prediction, const std::string& agreement) {
    const std::string words = verdict(correct);
    EXPECT_EQ(words.rfind(prediction, 0), 0u) << words;
    EXPECT_EQ(words.substr(words.rfind(": ") + 2), agreement) << words;
  };
  EXPECT_NE(verdict(52).find("52 % right [42 to 62], as by guessing"), std::string::npos) << verdict(52);
  EXPECT_NE(verdict(70).find("70 % right [60 to 78], more than by guessing"), std::string::npos) << verdict(70);
  const std::string few = "too few answers to decide, the interval contains 75 %.";
  const std::string below = "Predicted below the JND (at most 0.71 of it).";
  expect(52, below, "consistent.");
  expect(70, below, few);
  expect(97, below, "not consistent.");
  strokes.max_over_jnd = 3.0;
  const std::string moment = "Above the JND for a moment only (at most 3.00 of it, on average 0.20).";
  expect(52, moment, "less noticeable than one JND.");
  expect(97, moment, "more noticeable than one JND.");
  strokes.mean_over_jnd = 1.5;
  const std::string above = "Predicted above the JND (1.50 of it on average).";
  expect(52, above, "not consistent.");
  expect(70, above, few);
  expect(97, above, "consistent.");
  EXPECT_EQ(discrimination_verdict({"S01", 0, 0, 3}, strokes), above + " No usable answers yet.");
}

TEST(Discrimination, AnalysesFilesOfTheSameStrokesAlone) {
  StudyData one{discrimination_header(0.9), answers(60, 100)};
  StudyData two = one;
  two.header.subject = "S02";
  two.records = answers(80, 100);
  const auto results = analyse_discrimination({one, two});
  ASSERT_TRUE(results.ok()) << results.error().message;
  EXPECT_EQ(results->back().correct, 140u);
  EXPECT_EQ(results->back().trials, 200u);
  const std::string table = discrimination_table(*results, *one.header.strokes);
  EXPECT_NE(table.find("\nS02,100,80,0,0.8000,0.7112,0.8666,"), std::string::npos) << table;
  const auto complaint = [](const std::vector<StudyData>& files) {
    const auto refused = analyse_discrimination(files);
    return refused.ok() ? "accepted" : refused.error().message;
  };
  EXPECT_NE(complaint({}).find("found no study file"), std::string::npos);
  EXPECT_NE(complaint({one, one}).find("two files of subject S01"), std::string::npos);
  two.header.strokes = example_strokes(0.8);
  EXPECT_NE(complaint({one, two}).find("subject S02, strokes of"), std::string::npos) << complaint({one, two});
  two.header = {"S02"};
  EXPECT_NE(complaint({one, two}).find("subject S02, constant stimuli"), std::string::npos) << complaint({one, two});
  EXPECT_NE(complaint({two}), "accepted");
  one.records.clear();
  EXPECT_NE(complaint({one}).find("no usable answer of subject S01"), std::string::npos);
}

// The share of correct answers of a subject with the JND line `jnd`, averaged over `sessions`.
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
  // The largest unlimited force is 2 N, and the noise does not depend on force.
  EXPECT_NEAR(simulated_share(1.0 - 0.1 / 2.0, jnd, 40), 0.75, 0.024) << "one JND there";
  EXPECT_NEAR(simulated_share(1.0 + 0.1 / 2.0, jnd, 40), 0.75, 0.024) << "the larger one";
  EXPECT_GT(simulated_share(0.5, jnd, 5), 0.99) << "grossly different";
}

}  // namespace
}  // namespace palpate
