#include "scenes/evaluation/model_errors.h"

#include <gtest/gtest.h>

#include <utility>

#include "engine/base/random_stream.h"

namespace palpate {
namespace {

// Adds a recording with strokes of 100 samples, with `beyond` errors above the JND in each.
ModelErrors strokes_with(const std::vector<int>& beyond, ModelErrors errors = ModelErrors(JndLine{})) {
  errors.begin_recording();
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
  several = strokes_with({}, several);
  EXPECT_FALSE(several.unit_errors().units_are_recordings) << "the second recording has no contact";
  several = strokes_with({0}, strokes_with({1, 0}, several));
  EXPECT_TRUE(several.unit_errors().units_are_recordings);
  EXPECT_EQ(several.unit_errors().unit_within, (std::vector<double>{393.0, 199.0, 100.0}));
}

// The share has the bound of Student's t: 5 % beyond. Source of t: published tables.
TEST(UnitErrors, TheBoundOfTheShareHasStudentsT) {
  for (const auto& [degrees, t] :
       {std::pair{2, 2.920}, {3, 2.353}, {10, 1.812}, {29, 1.699}, {200, 1.6525}, {100'000, 1.6525}}) {
    SCOPED_TRACE(degrees);
    // Units of equal size whose shares have the standard error 0.1: the squared deviations from the mean sum to
    // n (n - 1).
    const auto units = static_cast<std::size_t>(degrees + 1);
    UnitErrors errors;
    errors.within_jnd = 0.9;
    errors.units_above_jnd = 1;
    errors.unit_samples.assign(units, 1.0);
    errors.unit_within.assign(units, 0.0);
    errors.unit_within.front() = 0.1 * static_cast<double>(units);
    EXPECT_NEAR(errors.within_at_least(), 0.9 - 0.1 * t, 5e-5);
  }
}

// Strokes of one error each, which takes the values 1 to n.
UnitErrors strokes_with_errors(int n) {
  ModelErrors errors(JndLine{1.0, 0.0});
  for (int stroke = 1; stroke <= n; ++stroke) {
    errors.begin_stroke();
    for (int i = 0; i < 50; ++i) errors.add(stroke, 0.0, false);
  }
  return errors.unit_errors();
}

// The 99 % error of a draw is the largest stroke in it, k with probability (k / n)^n - ((k - 1) / n)^n. For n = 10 the
// expanded percentiles are Phi(-1.054 x 2.262) = 0.86 % at each end: 6 has 0.6 % at or below it, 7 has 2.8 %.
TEST(Bootstrap, DrawsWholeStrokes) {
  const UnitErrors errors = strokes_with_errors(10);
  ASSERT_EQ(errors.drawn_units.p99.size(), kResamples);
  const auto share_up_to = [&](double most) {
    const auto count = std::ranges::count_if(errors.drawn_units.p99, [&](float one) { return one <= most; });
    return static_cast<double>(count) / kResamples;
  };
  // Four standard errors of a share of 2,000 draws are 4.5 points at most.
  EXPECT_NEAR(share_up_to(9.0), std::pow(0.9, 10), 0.045);
  EXPECT_NEAR(share_up_to(8.0), std::pow(0.8, 10), 0.03);
  EXPECT_EQ(errors.p99_interval().low, 7.0);
  EXPECT_EQ(errors.p99_interval().high, 10.0);
}

// Phi(-sqrt(10 / 9) x 2.262) = 0.86 % of 2,000 draws are 17, Phi(-sqrt(30 / 29) x 2.045) = 1.88 % are 37.
TEST(Bootstrap, TheIntervalIsExpandedForFewUnits) {
  UnitErrors errors;
  for (std::size_t i = 0; i < kResamples; ++i) errors.drawn_units.p99.push_back(static_cast<float>(i));
  for (const auto& [units, rank] : {std::pair{10, 17.0}, {30, 37.0}}) {
    errors.unit_samples.assign(static_cast<std::size_t>(units), 1.0);
    EXPECT_EQ(errors.p99_interval().low, rank);
    EXPECT_EQ(errors.p99_interval().high, 1999.0 - rank);
  }
}

TEST(Bootstrap, IsTheSameInEveryRunAndForEveryModelOfTheSameStrokes) {
  EXPECT_EQ(strokes_with_errors(12).drawn_units.p99, strokes_with_errors(12).drawn_units.p99);
  const Interval none = p99_difference(strokes_with_errors(12), strokes_with_errors(12));
  EXPECT_EQ(none.low, 0.0);
  EXPECT_EQ(none.high, 0.0);
}

TEST(ModelErrors, TooFewUnitsHaveNoIntervalAnywhere) {
  const UnitErrors unit_errors = strokes_with({3, 5}).unit_errors();
  EXPECT_LT(unit_errors.units(), kLeastUnits);
  EXPECT_FALSE(unit_errors.p99_interval().known());
  EXPECT_TRUE(std::isnan(unit_errors.within_at_least()));
  EXPECT_FALSE(p99_difference(unit_errors, unit_errors).known());
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
  EXPECT_NEAR(other.p99_error_over_jnd - one.p99_error_over_jnd, 0.03, 1e-6);
  const Interval difference = p99_difference(other, one);
  EXPECT_NEAR(difference.low, 0.03, 1e-6);
  EXPECT_NEAR(difference.high, 0.03, 1e-6);
}

// The rule of the best model.

struct RankCase {
  const char* what;
  std::vector<Candidate> candidates;
  std::size_t best, recommended;
};

TEST(Rank, IsTheRuleOfTwoSentences) {
  const RankCase cases[] = {
      {"the largest share", {{0.74, 2.0, 100.0}, {0.95, 2.0, 300.0}}, 1, 1},
      {"also with a lower 99 % error of another", {{0.91, 1.4, 100.0}, {0.95, 1.9, 300.0}}, 1, 1},
      {"less than half a point: the shortest tick", {{0.946, 2.0, 100.0}, {0.95, 2.0, 300.0}}, 1, 0},
      {"one alone has 99 %: its share decides", {{0.97, 1.2, 100.0}, {0.992, 0.9, 300.0}}, 1, 1},
      {"two have 99 %: the lowest 99 % error", {{0.999, 0.6, 100.0}, {0.995, 0.4, 300.0}}, 1, 1},
      {"less than 0.1 JND: the shortest tick", {{0.999, 0.49, 100.0}, {0.995, 0.4, 300.0}}, 1, 0},
      {"just below 99 % with a larger 99 % error",
       {{0.989, 1.1, 90.0}, {0.992, 0.9, 200.0}, {0.995, 0.4, 300.0}},
       2,
       2},
      {"a tick above the budget", {{0.99, 1.0, 60e3}, {0.91, 1.5, 300.0}}, 1, 1},
      {"all ticks above the budget", {{0.99, 1.0, 60e3}, {0.91, 1.5, 70e3}}, 0, 0},
  };
  for (const RankCase& one : cases) {
    const Ranking ranking = rank(one.candidates);
    EXPECT_EQ(ranking.best, one.best) << one.what;
    EXPECT_EQ(ranking.recommended, one.recommended) << one.what;
    EXPECT_TRUE(ranking.as_good[ranking.recommended]) << one.what;
  }
  EXPECT_EQ(rank({{0.99, 1.0, 60e3}, {0.91, 1.5, 300.0}}, 100e3).recommended, 0u) << "another budget";
  EXPECT_EQ(rank({{0.995, 0.9, 100.0}, {0.999, 0.4, 300.0}}).fastest_below_jnd, 0u);
  EXPECT_EQ(rank({{0.9, 1.9, 100.0}}).fastest_below_jnd, std::nullopt);
}

// Both models have the same share. In one pair each stroke differs by the same; in the other a single stroke decides.
TEST(Rank, ADifferenceThatTheBootstrapDoesNotTellFromZeroDoesNotCount) {
  for (const bool every : {true, false}) {
    ModelErrors good(JndLine{1.0, 0.0}), bad(JndLine{1.0, 0.0});
    for (int stroke = 0; stroke < 10; ++stroke) {
      for (ModelErrors* one : {&good, &bad}) one->begin_stroke();
      for (int i = 0; i < 50; ++i) {
        good.add(i < 2 ? 2.0 : 0.1, 0.0, false);
        bad.add(i < 2 || (every ? i < 4 : stroke == 0) ? 2.0 : 0.1, 0.0, false);
      }
    }
    const UnitErrors one = good.unit_errors(), other = bad.unit_errors();
    ASSERT_GT(one.within_jnd - other.within_jnd, kLeastShare);
    const auto candidate = [](const UnitErrors& errors, double tick_ns) {
      return Candidate{errors.within_jnd, errors.p99_error_over_jnd, tick_ns, &errors.drawn_strokes};
    };
    EXPECT_EQ(rank({candidate(other, 100.0), candidate(one, 300.0)}).recommended, every ? 1u : 0u);
  }
}

TEST(Recommendation, IsOneLine) {
  EXPECT_EQ(recommendation("trend+greedy-100", {0.9998, 0.4, 331.0}),
            "Use trend+greedy-100: 99.9 % of the test is within one JND, a tick takes 0.33 us.");
  EXPECT_EQ(recommendation("voxel", {0.879, 1.8, 12345.0}),
            "No model is good enough; the rule takes voxel: 87.9 % of the test is within one JND, a tick takes 12 us.");
  EXPECT_EQ(share_text(1.0), "100 %");
}

}  // namespace
}  // namespace palpate
