#include "scenes/evaluation/model_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

TEST(StrokeCounter, AStrokeGoesFromTouchToRelease) {
  StrokeCounter counter;
  int strokes = 0;
  for (int i = 0; i < 1000; ++i) {  // 10 Hz: the step exceeds the longest pause that is ascribed to noise
    strokes += counter.begins_stroke(0.1 * i, i % 100 >= 10) ? 1 : 0;
  }
  EXPECT_EQ(strokes, 10);
}

// Strokes of 100 samples, with `beyond` errors above the JND in each.
ModelErrors strokes_with(const std::vector<int>& beyond) {
  ModelErrors errors(JndLine{});
  for (const int count : beyond) {
    errors.begin_stroke();
    for (int i = 0; i < 100; ++i) errors.add(i < count ? 1.5 : 1.0, 1.0, false);
  }
  return errors;
}

TEST(ModelErrors, StrokesAreTheUnitsOfOneRecordingAndRecordingsOfSeveral) {
  ModelErrors several = strokes_with({0, 0, 0, 7});
  EXPECT_EQ(several.unit_errors().units(), 4u);
  EXPECT_FALSE(several.unit_errors().units_are_recordings);
  EXPECT_EQ(several.unit_errors().units_above_jnd, 1u);
  several.append(strokes_with({1, 0}));
  several.append(strokes_with({0}));
  EXPECT_TRUE(several.unit_errors().units_are_recordings);
  EXPECT_EQ(several.unit_errors().unit_within, (std::vector<double>{393.0, 199.0, 100.0}));
}

TEST(ModelErrors, ThreeSpotsThatDifferBoundTheShareAsStudentsTHasIt) {
  ModelErrors errors = strokes_with({21});
  errors.append(strokes_with({51}));
  errors.append(strokes_with({15}));
  EXPECT_NEAR(errors.unit_errors().within_at_least(), 0.384, 1e-3);
}

// Units whose 99 % errors have the standard error 1. Source of t: published tables.
TEST(UnitErrors, IntervalsHaveStudentsT) {
  struct Row {
    std::size_t degrees;
    double one_sided;  // 5 % beyond
    double two_sided;  // 2.5 % beyond
  };
  for (const Row& row :
       {Row{2, 2.920, 4.303}, {3, 2.353, 3.182}, {10, 1.812, 2.228}, {29, 1.699, 2.045}, {200, 1.6525, 1.9719}}) {
    SCOPED_TRACE(row.degrees);
    const auto units = static_cast<double>(row.degrees + 1);
    UnitErrors errors;
    errors.p99_error_over_jnd = 10.0;
    errors.unit_samples.assign(row.degrees + 1, 1.0);
    errors.unit_p99.assign(row.degrees + 1, 0.0);
    errors.unit_p99.front() = units;  // the squared deviations from the mean sum to n (n - 1)
    EXPECT_NEAR(errors.p99_at_most(), 10.0 + row.one_sided, 5e-4);
    EXPECT_NEAR(errors.p99_interval().low, 10.0 - row.two_sided, 5e-4);
    EXPECT_NEAR(errors.p99_interval().high, 10.0 + row.two_sided, 5e-4);
  }
}

// With very many units the bound is at least that of the normal distribution, 1.645, and larger by less than 0.7 %.
TEST(UnitErrors, WithManyUnitsTheBoundIsThatOfTheNormalDistribution) {
  constexpr std::size_t kUnits = 100'000;
  UnitErrors errors;
  errors.unit_samples.assign(kUnits, 1.0);
  errors.unit_p99.assign(kUnits, 0.0);
  errors.unit_p99.front() = kUnits;
  EXPECT_GE(errors.p99_at_most(), 1.6448);
  EXPECT_LT(errors.p99_at_most(), 1.007 * 1.6449);
}

TEST(ModelErrors, TooFewUnitsHaveNoIntervalAnywhere) {
  const UnitErrors unit_errors = strokes_with({3, 5}).unit_errors();
  EXPECT_FALSE(unit_errors.has_intervals());
  EXPECT_FALSE(unit_errors.p99_interval().known());
  EXPECT_TRUE(std::isnan(unit_errors.p99_at_most()));
  EXPECT_TRUE(std::isnan(unit_errors.within_at_least()));
  EXPECT_FALSE(paired_difference(unit_errors, unit_errors).interval.known());
}

TEST(ModelErrors, WithoutSamplesThereIsNothing) {
  const UnitErrors unit_errors = ModelErrors(JndLine{}).unit_errors();
  EXPECT_EQ(unit_errors.samples, 0u);
  EXPECT_EQ(unit_errors.units(), 0u);
  EXPECT_EQ(unit_errors.within_jnd, 0.0);
  EXPECT_EQ(unit_errors.p99_error_over_jnd, 0.0);
  EXPECT_TRUE(unit_errors.bins.empty());
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

// Twelve strokes are all within the JND. The exact 95 % limit of the share beyond is 1 - 0.05^(1/12).
TEST(ModelErrors, WhereNothingGoesBeyondTheBoundIsExact) {
  EXPECT_NEAR(strokes_with(std::vector<int>(12, 0)).unit_errors().within_at_least(), 0.7791, 1e-4);
}

// One model has an error larger by 0.03 JND in every stroke, and strokes differ by thirty
// times that. The intervals overlap, but the interval of the paired difference excludes 0.
TEST(PairedDifference, SeparatesOverlappingSamples) {
  const JndLine jnd{0.1, 0.0};
  ModelErrors good(jnd), bad(jnd);
  RandomStream random(4, 0);
  for (int stroke = 0; stroke < 20; ++stroke) {
    const double error_N = 0.1 * (0.5 + random.uniform(0.0, 1.0));
    for (ModelErrors* one : {&good, &bad}) one->begin_stroke();
    for (int i = 0; i < 50; ++i) {
      good.add(1.0 + error_N, 1.0, false);
      bad.add(1.0 + error_N + 0.003, 1.0, false);
    }
  }
  const UnitErrors one = good.unit_errors();
  const UnitErrors other = bad.unit_errors();
  EXPECT_LT(other.p99_interval().low, one.p99_interval().high) << "they overlap";
  const PairedDifference difference = paired_difference(other, one);
  EXPECT_NEAR(difference.p99, 0.03, 1e-6);
  EXPECT_NEAR(difference.interval.low, 0.03, 1e-6);
  EXPECT_NEAR(difference.at_most, 0.03, 1e-6);
}

TEST(ModelErrors, EqualErrorsAreOneModel) {
  EXPECT_TRUE(strokes_with({1, 2}).equals(strokes_with({1, 2})));
  EXPECT_FALSE(strokes_with({1, 2}).equals(strokes_with({2, 1})));
}

}  // namespace
}  // namespace palpate
