#include "scenes/evaluation/model_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

TEST(StrokeCounter, AStrokeGoesFromTouchToReleaseAndLongOnesAreCut) {
  StrokeCounter counter(100.0);
  int strokes = 0;
  int blocks = 0;
  for (int i = 0; i < 1000; ++i) {  // 10 Hz: the step is longer than the pause that noise may make
    const double time_s = 0.1 * i;
    const bool in_contact = i % 100 >= 10;  // 9 s at a time
    blocks += counter.begins_block(time_s, in_contact) ? 1 : 0;
    strokes += in_contact && counter.begins_stroke() ? 1 : 0;
  }
  EXPECT_EQ(strokes, 10);
  EXPECT_EQ(blocks, 50) << "9 s are five pieces of at most 2 s";
}

TEST(StrokeCounter, AShortRecordingHasTenBlocksAtLeast) {
  StrokeCounter counter(5.0);
  int blocks = 0;
  for (int i = 0; i < 5000; ++i) blocks += counter.begins_block(1e-3 * i, true) ? 1 : 0;
  EXPECT_EQ(blocks, 10) << "half a second each";
}

TEST(ModelErrors, NeighbouringSamplesThatAreAlikeTellLess) {
  // Twenty strokes of 500 samples, all of a stroke with the same error: as if twenty samples.
  const JndLine jnd;
  ModelErrors errors(jnd);
  RandomStream random(1, 0);
  double squares = 0.0;
  for (int stroke = 0; stroke < 20; ++stroke) {
    const double error_N = 0.02 * random.normal();
    squares += error_N * error_N;
    errors.begin_block(true);
    for (int i = 0; i < 500; ++i) errors.add(1.0 + error_N, 1.0, false);
  }
  const Evidence evidence = errors.evidence();
  const double rms_N = std::sqrt(squares / 20.0);
  EXPECT_NEAR(evidence.rms_error_N, rms_N, 1e-12);
  EXPECT_EQ(evidence.strokes, 20u);
  // The standard error of an RMS of 20 normal values is rms / sqrt(40); 95 % are 1.96
  // times that to either side. A factor of 1.6 either way allows for the one draw here.
  const double width_N = evidence.rms_interval_N().high - evidence.rms_interval_N().low;
  const double expected_N = 2.0 * 1.96 * rms_N / std::sqrt(40.0);
  EXPECT_GT(width_N, expected_N / 1.6);
  EXPECT_LT(width_N, expected_N * 1.6);
  EXPECT_LE(evidence.rms_interval_N().low, rms_N);
  EXPECT_GE(evidence.rms_interval_N().high, rms_N);
}

TEST(ModelErrors, CountsWhatDecides) {
  ModelErrors errors(JndLine{});
  for (int stroke = 0; stroke < 10; ++stroke) {
    errors.begin_block(true);
    for (int i = 0; i < 100; ++i) errors.add(stroke == 3 && i < 7 ? 1.5 : 1.0, 1.0, false);
  }
  const Evidence evidence = errors.evidence();
  EXPECT_EQ(evidence.beyond_samples, 7u);
  EXPECT_EQ(evidence.beyond_strokes, 1u);
  EXPECT_EQ(evidence.within_interval().high, 1.0) << "a resampling without that stroke is likely";
  EXPECT_LT(evidence.within_interval().low, 0.993);
  EXPECT_EQ(evidence.p99_interval().low, 0.0);
}

TEST(ModelErrors, TheSameSamplesGiveTheSameIntervals) {
  const auto run = [] {
    ModelErrors errors(JndLine{});
    RandomStream random(2, 0);
    for (int stroke = 0; stroke < 12; ++stroke) {
      errors.begin_block(true);
      for (int i = 0; i < 50; ++i) errors.add(1.0 + 0.1 * random.normal(), 1.0, false);
    }
    return errors.evidence();
  };
  EXPECT_EQ(run().p99_interval().low, run().p99_interval().low);
  EXPECT_EQ(run().p99_interval().high, run().p99_interval().high);
}

TEST(ModelErrors, WithoutSamplesThereIsNothing) {
  const Evidence evidence = ModelErrors(JndLine{}).evidence();
  EXPECT_EQ(evidence.samples, 0u);
  EXPECT_EQ(evidence.blocks, 0u);
  EXPECT_EQ(evidence.p99_error_over_jnd, 0.0);
  EXPECT_EQ(evidence.within_at_least(), 0.0);
  EXPECT_TRUE(evidence.bins.empty());
}

// Errors 1, 2 ... 1000 mN at a JND of 500 mN throughout.
TEST(ModelErrors, UniformErrorsHaveTheirClosedForms) {
  ModelErrors errors(JndLine{0.5, 0.0});
  const int n = 1000;
  for (int i = 1; i <= n; ++i) errors.add(0.2 + 1e-3 * ((i % 2 != 0) ? i : -i), 0.2, i == 1);
  const ErrorSummary summary = errors.summary();
  // Sum of squares n(n+1)(2n+1)/6.
  EXPECT_NEAR(summary.rms_error_N, 1e-3 * std::sqrt((n + 1.0) * (2.0 * n + 1.0) / 6.0), 1e-12);
  EXPECT_NEAR(summary.max_error_N, 1.0, 1e-12);
  EXPECT_NEAR(summary.within_jnd, 0.5, 1.5e-3) << "the one at the limit may round either way";
  EXPECT_NEAR(summary.p99_error_over_jnd, 0.990 / 0.5, 2e-7) << "stored as a float";
  EXPECT_NEAR(summary.max_error_over_jnd, 2.0, 1e-12);
  EXPECT_EQ(summary.out_of_domain_samples, 1u);
}

TEST(ModelErrors, TheJndIsThatOfTheMeasuredForce) {
  ModelErrors errors(JndLine{});
  errors.add(2.0 + 0.065 + 0.0633 * 2.0 - 1e-9, 2.0, false);
  errors.add(2.0 + 0.065 + 0.0633 * 2.0 + 1e-9, 2.0, false);
  EXPECT_EQ(errors.summary().within_jnd, 0.5);
}

TEST(ModelErrors, PercentileIsTheNearestRank) {
  for (const int n : {1, 2, 99, 100, 101, 200, 1000}) {
    ModelErrors errors(JndLine{1.0, 0.0});
    for (int i = n; i >= 1; --i) errors.add(i, 0.0, false);
    const double expected = std::ceil(0.99 * n - 1e-9);
    EXPECT_NEAR(errors.summary().p99_error_over_jnd, expected, expected * 1e-7) << n;
  }
}

TEST(ModelErrors, OfTwoRecordingsAreThoseOfBoth) {
  const JndLine jnd;
  ModelErrors both(jnd), first(jnd), second(jnd);
  RandomStream random(3, 0);
  for (int stroke = 0; stroke < 10; ++stroke) {
    ModelErrors& half = stroke < 4 ? first : second;
    half.begin_block(true);
    both.begin_block(true);
    for (int i = 0; i < 30; ++i) {
      const double model_N = 1.0 + 0.2 * random.normal();
      half.add(model_N, 1.0, false);
      both.add(model_N, 1.0, false);
    }
  }
  first.append(second);
  EXPECT_EQ(first.evidence().strokes, 10u);
  EXPECT_EQ(first.evidence().beyond_strokes, both.evidence().beyond_strokes);
  EXPECT_EQ(first.evidence().p99_draws, both.evidence().p99_draws);
}

// Twelve strokes that are all within one JND: of such strokes up to a quarter may be beyond.
TEST(ModelErrors, WhereNothingGoesBeyondTheRuleOfThreeBoundsIt) {
  ModelErrors errors(JndLine{});
  for (int stroke = 0; stroke < 12; ++stroke) {
    errors.begin_block(true);
    for (int i = 0; i < 50; ++i) errors.add(1.0, 1.0, false);
  }
  EXPECT_NEAR(errors.evidence().within_at_least(), 0.75, 1e-12);
}

// One model is worse than another by 0.03 JND in every stroke, and strokes differ by
// thirty times that: their intervals overlap, and the paired difference tells them apart.
TEST(PairedDifference, TellsApartWhatOverlaps) {
  const JndLine jnd{0.1, 0.0};
  ModelErrors good(jnd), bad(jnd), same(jnd);
  RandomStream random(4, 0);
  for (int stroke = 0; stroke < 20; ++stroke) {
    const double error_N = 0.1 * (0.5 + random.uniform(0.0, 1.0));
    for (ModelErrors* one : {&good, &bad, &same}) one->begin_block(true);
    for (int i = 0; i < 50; ++i) {
      good.add(1.0 + error_N, 1.0, false);
      bad.add(1.0 + error_N + 0.003, 1.0, false);
      same.add(1.0 - error_N, 1.0, false);
    }
  }
  const Evidence one = good.evidence();
  const Evidence other = bad.evidence();
  EXPECT_LT(other.p99_interval().low, one.p99_interval().high) << "they overlap";
  const PairedDifference difference = paired_difference(other, one);
  EXPECT_FALSE(difference.tied());
  EXPECT_NEAR(difference.p99, 0.03, 1e-6);
  EXPECT_NEAR(difference.interval.low, 0.03, 1e-6);
  EXPECT_TRUE(paired_difference(one, same.evidence()).tied());
}

}  // namespace
}  // namespace palpate
