#include "models/samples/samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>

#include "tests/support/example_model.h"
#include "tests/support/feature_specs.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

using test::must;

Samples samples_of(const std::vector<Recording>& recordings, std::size_t most_rows = kMaximumRows) {
  std::vector<PreparedRecordingPointer> prepared;
  for (const Recording& recording : recordings) prepared.push_back(prepare_recording(recording));
  return must(make_samples(std::move(prepared), JndLine{}, {}, most_rows));
}

// Presses of a spring of 500 N/m from 3 mm outside to 5 mm inside and back within 0.8 s, 0.2 s apart, at 1 kHz. The
// surface is at `surface_m` and the force zero at `zero_N`.
Recording presses(int count, double surface_m = 0.0, double zero_N = 0.0) {
  Recording recording;
  recording.name = std::to_string(count) + " presses";
  for (int i = 0; i < 1000 * count; ++i) {
    const double depth_m = std::max(-3e-3, 5e-3 - 20e-3 * std::abs(1e-3 * (i % 1000) - 0.4));
    recording.rows.push_back({1e-3 * i, depth_m + surface_m, 500.0 * std::max(0.0, depth_m) + zero_N, 0.0, 0.0});
  }
  return recording;
}

// The same without free air: from 1 to 5 mm.
Recording strokes_in_contact(int count) {
  Recording recording;
  recording.name = "in contact";
  for (int i = 0; i < 1000 * count; ++i) {
    const double depth_m = 3e-3 - 2e-3 * std::cos(2e-3 * M_PI * i);
    recording.rows.push_back({1e-3 * i, depth_m, 500.0 * depth_m, 0.0, 0.0});
  }
  return recording;
}

// The accuracy of a surface estimate: a step of the positions of 0.02 mm (kLeastOffset_m).
constexpr double kSurface_m = 0.02e-3;

void expect_depths_and_forces(const Samples& samples) {
  EXPECT_NEAR(samples.depth_m, 5e-3, 0.1e-3);  // the error of the motion estimate at a turn
  for (const std::size_t i : samples.contact) {
    // The stiffness times the accuracy of the surface.
    ASSERT_NEAR(samples.rows[i].force_N, 500.0 * samples.rows[i].tool.position_m, 500.0 * kSurface_m) << i;
  }
}

TEST(Samples, TheSurfaceOfOneRecordingIsThatOfTheTable) {
  for (const double surface_m : {-12e-3, 0.4e-3, 12e-3}) {
    const Samples samples = samples_of({presses(4, surface_m)});
    EXPECT_NEAR(samples.surface_m, surface_m, kSurface_m);
    EXPECT_EQ(samples.offsets[0].offset_m, 0.0);
    EXPECT_TRUE(std::isfinite(samples.offsets[0].standard_error_m));
    EXPECT_EQ(samples.stroke.back(), 4) << surface_m;
    expect_depths_and_forces(samples);
  }
}

TEST(Samples, OneRecordingOfThreeIsMoved) {
  for (const double surface_m : {-12e-3, 12e-3}) {
    const Samples samples = samples_of({presses(5), presses(4, surface_m), presses(3)});
    EXPECT_EQ(samples.surface_m, 0.0);
    ASSERT_EQ(samples.offsets.size(), 3u);
    EXPECT_EQ(samples.offsets[0].offset_m, 0.0);
    EXPECT_NEAR(samples.offsets[1].offset_m, surface_m, kSurface_m);
    EXPECT_EQ(samples.offsets[2].offset_m, 0.0);
    EXPECT_EQ(samples.stroke.back(), 12);
    expect_depths_and_forces(samples);
  }
}

// Its forces cannot be told from those of another depth, whatever the other recordings show.
TEST(Samples, ARecordingWithoutFreeAirHasNoOffsetOfItsOwn) {
  const Samples samples = samples_of({strokes_in_contact(6), presses(5), presses(4, 2e-3)});
  EXPECT_NEAR(samples.surface_m, 2e-3, kSurface_m) << "the upper one of two";
  EXPECT_EQ(samples.offsets[0].offset_m, 0.0);
  EXPECT_TRUE(std::isinf(samples.offsets[0].standard_error_m));
  EXPECT_NEAR(samples.offsets[1].offset_m, -2e-3, kSurface_m);
  const Samples alone = samples_of({strokes_in_contact(6)});
  EXPECT_EQ(alone.surface_m, 0.0);
  EXPECT_EQ(alone.contact.size(), 6000u);
}

// A piston, whose zero is somewhere in its way: a force at every position.
TEST(Samples, WhereEveryPositionHasAForceTheSurfaceIsOutsideOfAll) {
  const auto surface_m = [](double lowest_m, int loaded, bool air) {
    Recording recording;
    recording.name = "piston";
    int outside = 0;
    for (int i = 0; i < 4000; ++i) {
      const double out = 0.5 + 0.5 * std::cos(2e-3 * M_PI * i);
      const double position_m = 5e-3 + (lowest_m - 5e-3) * out;
      const bool within = position_m > 0.0 || outside++ < loaded;
      const double force_N = 3.0 + std::sin(9.0 * out);
      recording.rows.push_back({1e-3 * i, position_m, within && !(air && position_m < 1e-3) ? force_N : 0.0, 0.0, 0.0});
    }
    return samples_of({recording}).surface_m;
  };
  constexpr double kRange_m = 7e-3;
  EXPECT_NEAR(surface_m(-2e-3, 4000, false), -2e-3 - 0.05 * kRange_m, 1e-12);
  EXPECT_EQ(surface_m(-2e-3, 5, false), 0.0) << "fewer than ten rows and 1 %";
  EXPECT_LT(surface_m(-0.05e-3, 4000, false), -1e-3) << "hardly outside of 0: where the line through the forces is 0";
  EXPECT_GT(surface_m(-2e-3, 0, true), -1e-3) << "free air";
}

TEST(Samples, TheOrderOfRecordingsIsIrrelevant) {
  const Recording a = presses(3);
  Recording b = presses(3, 1e-3);
  b.name = a.name;
  const Recording c = presses(4, 0.5e-3);
  const Samples one = samples_of({a, b, c});
  const Samples other = samples_of({c, b, a});
  EXPECT_EQ(one.offsets[0].name, "4 presses");
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(one.offsets[k].content_hash, other.offsets[k].content_hash);
    EXPECT_EQ(one.offsets[k].offset_m, other.offsets[k].offset_m);
  }
  EXPECT_EQ(one.recording, other.recording);
  EXPECT_EQ(one.stroke, other.stroke);
  EXPECT_EQ(one.fold, other.fold);
  EXPECT_EQ(one.contact, other.contact);
  ASSERT_EQ(one.rows.size(), other.rows.size());
  for (std::size_t i = 0; i < one.rows.size(); ++i) {
    ASSERT_EQ(one.rows[i].motion.position_m, other.rows[i].motion.position_m);
    ASSERT_EQ(one.rows[i].force_N, other.rows[i].force_N);
  }
}

// Pulls of 0.2 N, above the JND of 0.065 N at 0 N: in one sample of a hundred, or in nine samples.
TEST(Samples, AMaterialThatPullsHasNegativeForces) {
  const auto pulled = [](int samples_that_pull) {
    Recording recording = presses(4);
    for (std::size_t i = 0; samples_that_pull > 0; i += 20) {
      if (!(recording.rows[i].position_m > 0.0)) continue;
      recording.rows[i].force_N = -0.2;
      --samples_that_pull;
    }
    std::vector<PreparedRecordingPointer> prepared{prepare_recording(recording)};
    const Samples samples = must(make_samples(prepared, JndLine{}));
    EXPECT_EQ(std::isinf(samples.no_force_N()), samples.lowest_force_N < 0.0);
    return samples.lowest_force_N;
  };
  EXPECT_NEAR(pulled(20), -0.2, 1e-6);
  EXPECT_EQ(pulled(9), 0.0);
}

TEST(Samples, ThreeRecordingsOrMoreFormFoldsOfWholeRecordings) {
  for (const int count : {3, 6, 8}) {
    std::vector<Recording> recordings;
    for (int k = 0; k < count; ++k) recordings.push_back(presses(2 + k));
    const Samples samples = samples_of(recordings);
    EXPECT_EQ(samples.folds, std::min(count, 6));
    for (std::size_t i = 0; i < samples.rows.size(); ++i) ASSERT_EQ(samples.fold[i], samples.recording[i] % 6);
  }
}

TEST(Samples, FewerRecordingsFormFoldsOfWholeStrokes) {
  for (const std::vector<Recording>& recordings : {std::vector{presses(20)}, std::vector{presses(12), presses(8)}}) {
    const Samples samples = samples_of(recordings);
    EXPECT_EQ(samples.folds, 5);
    for (const std::size_t i : samples.contact) ASSERT_EQ(samples.fold[i], (samples.stroke[i] - 1) % 5) << i;
  }
}

// A recording of one stroke: the folds and the number of pieces.
std::pair<std::size_t, int> pieces_of(const Samples& samples) {
  std::set<int> folds;
  int pieces = 1;
  for (std::size_t k = 0; k < samples.contact.size(); ++k) {
    folds.insert(samples.fold[samples.contact[k]]);
    pieces += k > 0 && samples.fold[samples.contact[k]] != samples.fold[samples.contact[k - 1]] ? 1 : 0;
  }
  return {folds.size(), pieces};
}

TEST(Samples, ALongStrokeIsCutIntoPiecesOfEveryFold) {
  EXPECT_EQ(pieces_of(samples_of({strokes_in_contact(5)})), std::pair(std::size_t{5}, 10));
  Recording inwards;
  for (int i = 0; i < 5000; ++i) inwards.rows.push_back({1e-3 * i, 1e-6 * (i + 1), 5e-4 * i, 0.0, 0.0});
  EXPECT_EQ(pieces_of(samples_of({inwards})), std::pair(std::size_t{5}, 50)) << "without unloading";
}

// Presses by half of the range are units, in air or in contact; recordings where there are several.
TEST(Samples, UnitsArePressesOrRecordings) {
  EXPECT_EQ(samples_of({presses(4)}).units, 4);
  const Samples alone = samples_of({strokes_in_contact(6)});
  EXPECT_EQ(alone.units, 6);
  EXPECT_EQ(alone.unit.back(), 5);
  for (std::size_t i = 1; i < alone.unit.size(); ++i) {
    if (alone.unit[i] == alone.unit[i - 1]) continue;
    EXPECT_EQ(alone.unit[i], alone.unit[i - 1] + 1);
    EXPECT_LT(alone.rows[i].motion.position_m, 1.2e-3) << "at the lowest position";
  }
  const Samples both = samples_of({presses(4), strokes_in_contact(6)});
  EXPECT_EQ(both.units, 2);
  EXPECT_EQ(both.unit, both.recording);
}

// Every `nth` row, with the motion that was estimated from all rows.
TEST(Samples, OfLongRecordingsEveryNthRowIsKept) {
  const std::vector<Recording> recordings{test::example_recording(60000, 1000.0, 30e-6),
                                          test::example_recording(30000, 1000.0)};
  const Samples whole = samples_of(recordings);
  const Samples few = samples_of(recordings, 8000);
  EXPECT_EQ(few.recorded_rows, 90000u);
  EXPECT_EQ(few.force_noise_N, whole.force_noise_N);
  EXPECT_EQ(few.sensor.encoder_step_m, whole.sensor.encoder_step_m);
  EXPECT_EQ(few.surface_m, whole.surface_m);
  ASSERT_EQ(few.rows.size(), 7500u);  // every 12th
  for (std::size_t i = 0; i < few.rows.size(); ++i) {
    ASSERT_EQ(few.rows[i].tool.position_m, whole.rows[12 * i].tool.position_m);
    ASSERT_EQ(few.rows[i].motion.velocity_m_per_s, whole.rows[12 * i].motion.velocity_m_per_s);
    ASSERT_EQ(few.rows[i].force_N, whole.rows[12 * i].force_N);
    ASSERT_EQ(few.recording[i], whole.recording[12 * i]);
  }
}

// Twelve features, in two filters of eight and four.
std::vector<FeatureSpec> many_features() {
  std::vector<FeatureSpec> features = test::memory_features();
  for (const double time_s : {0.01, 0.03, 0.1, 0.3, 1.0}) features.push_back(test::lowpass(time_s));
  features.push_back(test::spectrum({0.05}, test::stiffening()));
  features.push_back(test::stops({1e-4}, test::stiffening()));
  return features;
}

TEST(FeaturesAt, AreThoseOfAFilterOneByOne) {
  const Samples samples = samples_of({presses(3), presses(2, 1e-3)});
  const std::vector<FeatureSpec> features = many_features();
  ASSERT_GT(features.size(), kMaxFeatures);
  for (const std::size_t stride : {1u, 7u}) {
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < samples.contact.size(); i += stride) rows.push_back(samples.contact[i]);
    const Eigen::MatrixXd values = must(features_at(samples, features, rows));
    ASSERT_EQ(values.rows(), static_cast<Eigen::Index>(features.size()));
    ASSERT_EQ(values.cols(), static_cast<Eigen::Index>(rows.size()));
    for (std::size_t f = 0; f < features.size(); ++f) {
      std::size_t column = 0;
      FeatureFilter filter({features[f]});
      for (std::size_t i = 0; i < samples.rows.size(); ++i) {
        if (i == 3000) filter.reset();  // the memory does not reach into the next recording
        const double value = filter.update(samples.rows[i].tool, samples.rows[i].motion).values[0];
        if (column == rows.size() || rows[column] != i) continue;
        // Sums over lanes may be added in another order: rounding of forces of some newtons.
        ASSERT_NEAR(values(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(column)), value, 1e-13) << f;
        ++column;
      }
      EXPECT_EQ(column, rows.size());
    }
  }
  EXPECT_EQ(must(features_at(samples, features, {})).cols(), 0);
  EXPECT_EQ(must(features_at(samples, {}, {samples.contact[0]})).rows(), 0);
}

TEST(RecordingEnds, AreThoseAsRecordedWithTheMemoryOfAFilter) {
  const std::vector<FeatureSpec> features = {FeatureSpec{}, test::spectrum({0.3}, test::stiffening())};
  const Samples samples = samples_of({presses(3, 1e-3), strokes_in_contact(2)});
  const std::vector<RecordingEnds> ends = recording_ends(samples, features);
  ASSERT_EQ(ends.size(), 2u);
  EXPECT_NEAR(ends[0].first_position_m, -2e-3, 1e-12);
  EXPECT_NEAR(ends[1].first_position_m, 1e-3, 1e-12);
  EXPECT_NEAR(ends[1].last_position_m, 1e-3, 1e-6);
  const Eigen::MatrixXd values = must(features_at(samples, features, {samples.rows.size() - 1}));
  EXPECT_EQ(ends[1].memory, std::vector{values(1, 0)});
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

const SearchRange kRange{-10.0, 10.0, 0.5, 1e-3, 1.0};

// Ten blocks, each a parabola with its minimum near `at`.
BlockCosts bowl(double x, double at, double floor) {
  BlockCosts costs;
  for (int b = 0; b < 10; ++b) costs.push_back(floor + (x - at - 0.02 * (b - 4.5)) * (x - at - 0.02 * (b - 4.5)));
  return costs;
}

TEST(ProfileSearch, FindsTheOffsetThatAllBlocksAgreeOn) {
  const OffsetEstimate found = estimate_offset([](double x) { return bowl(x, 7.3, 0.01); }, kRange);
  EXPECT_TRUE(found.identified);
  EXPECT_NEAR(found.at, 7.3, 0.01);
  EXPECT_LT(found.standard_error, 0.2);
}

TEST(ProfileSearch, ZeroStandsWhileItIsAsGood) {
  const OffsetEstimate found = estimate_offset([](double x) { return bowl(x, 0.03, 1.0); }, kRange);
  EXPECT_TRUE(found.identified);
  EXPECT_EQ(found.at, 0.0);
}

// If the material can imitate an offset, all blocks have the same error. The jackknife gives
// 0.05 +- 0.02, but the cost is not significantly lower than at 0.
TEST(ProfileSearch, AnOffsetThatTheMaterialImitatesIsNotIdentified) {
  SearchRange with_effect = kRange;
  with_effect.systematic_effect = 0.3;
  const OffsetEstimate found = estimate_offset([](double x) { return bowl(x, 0.05, 1.0); }, with_effect);
  EXPECT_FALSE(found.identified);
  EXPECT_EQ(found.at, 0.0);
  EXPECT_NEAR(estimate_offset([](double x) { return bowl(x, 7.3, 0.01); }, with_effect).at, 7.3, 0.01);
}

TEST(ProfileSearch, AnEdgeTwoMinimaOrOneBlockIdentifyNothing) {
  const auto edge = [](double x) { return bowl(x, 14.0, 0.01); };
  const auto two = [](double x) { return bowl(std::abs(x), 5.0, 0.01); };
  const auto lone = [](double x) {
    BlockCosts costs(10, 1.0);
    costs[3] += (x - 5.0) * (x - 5.0);
    return costs;
  };
  for (const std::function<BlockCosts(double)>& cost : {std::function<BlockCosts(double)>(edge), {two}, {lone}}) {
    const OffsetEstimate found = estimate_offset(cost, kRange);
    EXPECT_FALSE(found.identified);
    EXPECT_EQ(found.at, 0.0);
  }
  EXPECT_TRUE(estimate_offset(two, kRange).not_zero);
}

// A linear spring: a surface offset of 1 equals a force offset of 3.
TEST(ProfileSearch, WhatAForceOffsetExplainsAsWellIsNotTold) {
  const OffsetEstimate shift = estimate_offset([](double x) { return bowl(x, 1.0, 0.01); }, kRange);
  ASSERT_TRUE(shift.identified);
  const OffsetEstimate both = unless_force_offset(
      shift, [](double f_N) { return bowl(f_N / 3.0, 1.0, 0.01); }, 10.0);
  EXPECT_FALSE(both.identified);
  EXPECT_EQ(both.at, 0.0);
  EXPECT_NEAR(both.minimum_at, 1.0, 0.01);
  EXPECT_NEAR(both.force_offset_N, 3.0, 0.05);
  EXPECT_FALSE(both.force_offset_better);
  EXPECT_TRUE(unless_force_offset(
                  shift, [](double f_N) { return bowl(f_N / 3.0, 1.0, 0.001); }, 10.0)
                  .force_offset_better);
  const OffsetEstimate only = unless_force_offset(
      shift, [](double f_N) { return bowl(f_N / 3.0, 1.0, 9.0); }, 10.0);
  EXPECT_TRUE(only.identified);
  EXPECT_EQ(only.at, shift.at);
  EXPECT_EQ(only.force_offset_N, 0.0);
}

}  // namespace
}  // namespace palpate
