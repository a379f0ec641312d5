#include "models/correction/thinning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

MotionSource source_of(Recording recording) { return MotionSource({prepare_recording(std::move(recording))}); }

// A recording at 1 kHz with given positions and forces.
template <typename Function>
Recording recording_of(int rows, Function position_and_force) {
  Recording recording;
  recording.name = "made";
  for (int i = 0; i < rows; ++i) {
    const auto [position_m, force_N] = position_and_force(i);
    recording.rows.push_back({1e-3 * i, position_m, force_N, 0.0, 0.0});
  }
  return recording;
}

TrainingSet set_of(const Recording& recording, const std::vector<FeatureSpec>& features, Reduction reduction,
                   double force_noise_floor_N = 0.01) {
  MotionSource source = source_of(recording);
  auto set = make_training_set(source, features, reduction, force_noise_floor_N);
  EXPECT_TRUE(set.ok());
  return *set;
}

// Noise fills the four dimensions, so that without the cap almost every sample would be
// a site.
TEST(TrainingSet, CoverageNeverLeavesMoreThanItsCap) {
  test::Numbers noise(1);
  const Recording recording = recording_of(80000, [&](int i) {
    const double position_m = 3e-3 + 2e-3 * std::sin(0.02 * i) * std::sin(0.0013 * i) + 5e-4 * noise.next();
    return std::pair{position_m, 0.5 + 300.0 * position_m + 0.1 * noise.next()};
  });
  const TrainingSet set = set_of(recording, test::paper_features(), Reduction::coverage);
  EXPECT_LE(set.sites.size(), kMaximumSites);
  EXPECT_GT(set.sites.size(), kMaximumSites / 10);
  double samples = 0.0;
  for (const TrainingSite& site : set.sites) samples += site.count;
  EXPECT_EQ(samples, static_cast<double>(set.contact_samples));
}

// The tool rests at ten positions, and the only feature is depth: ten sites, each with the mean of its
// samples. The positions are unevenly spaced, because equal spaces would look like encoder steps.
TEST(TrainingSet, ASiteIsTheMeanOfItsCube) {
  const Recording recording = recording_of(5000, [](int i) {
    const int place = i / 500;
    return std::pair{1e-3 * (1 + place) + 2e-4 * std::sin(place), 1.0 + i / 500 + (i % 2 == 0 ? 0.1 : -0.1)};
  });
  const TrainingSet set = set_of(recording, test::position_features(), Reduction::coverage);
  double samples = 0.0;
  double forces = 0.0;
  double depths = 0.0;
  for (const TrainingSite& site : set.sites) {
    samples += site.count;
    forces += site.count * site.force_N;
    depths += site.count * site.features[0];
  }
  EXPECT_EQ(samples, 5000.0);
  EXPECT_NEAR(forces / samples, 5.5, 1e-9);  // the mean of 1 to 10; tolerance: rounding of running means
  EXPECT_NEAR(depths / samples, set.normalisation.offset(0), 1e-12);
  std::size_t large = 0;
  for (const TrainingSite& site : set.sites) {
    if (site.count < 300.0) continue;  // samples during the transient of the motion estimator
    ++large;
    EXPECT_NEAR(site.force_N, std::round(site.force_N), 2e-3);
  }
  EXPECT_GE(large, 8u);  // a rest position may be on the boundary of a cube
}

TEST(TrainingSet, SamplesWithoutForceShareNoSite) {
  const Recording recording = recording_of(2000, [](int i) {
    return std::pair{2e-3, i % 2 == 0 ? 0.0 : 1.0};  // the same place, with and without
  });
  const TrainingSet set = set_of(recording, test::position_features(), Reduction::coverage);
  for (const TrainingSite& site : set.sites) {
    EXPECT_EQ(site.force_N, site.no_force ? 0.0 : 1.0);
  }
  EXPECT_EQ(set.contact_samples, 2000u);
}

TEST(TrainingSet, ForceReductionKeepsThePapersSamples) {
  const Recording recording = recording_of(3000, [](int i) {
    return std::pair{3e-3 + 1e-3 * std::sin(0.01 * i), 2.0 + std::sin(0.01 * i) + 0.02 * std::sin(0.7 * i)};
  });
  const TrainingSet set = set_of(recording, test::position_features(), Reduction::force);
  // The rule of section 2.1, implemented independently.
  std::vector<double> expected;
  for (const RecordingRow& row : recording.rows) {
    if (expected.empty() || std::abs(row.force_N - expected.back()) >= 0.05) expected.push_back(row.force_N);
  }
  ASSERT_EQ(set.sites.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(set.sites[i].force_N, expected[i]);
  EXPECT_EQ(set.reduction_force_N, 0.05);
}

TEST(TrainingSet, ForceReductionOfNoiseStaysBelowItsCap) {
  test::Numbers noise(2);
  const Recording recording = recording_of(60000, [&](int) { return std::pair{3e-3, 5.0 + 2.0 * noise.next()}; });
  const TrainingSet set = set_of(recording, test::position_features(), Reduction::force);
  EXPECT_LE(set.sites.size(), kMaximumSites);
  EXPECT_GT(set.reduction_force_N, 0.05);
}

TEST(TrainingSet, NoReductionKeepsEverySampleInContact) {
  const Recording recording = test::example_recording(5000, 1000.0);
  const TrainingSet set = set_of(recording, test::paper_features(), Reduction::none);
  std::size_t contact = 0;
  for (const RecordingRow& row : recording.rows) contact += row.position_m > 0.0 ? 1 : 0;
  EXPECT_EQ(set.sites.size(), contact);
  EXPECT_EQ(set.contact_samples, contact);
}

// u = (x - mean) / sqrt(range 4 sigma), from the samples themselves.
TEST(TrainingSet, NormalisesByRangeAndDeviation) {
  const TrainingSet set = set_of(test::example_recording(5000, 1000.0), test::paper_features(), Reduction::none);
  Eigen::ArrayXXd x(4, static_cast<Eigen::Index>(set.sites.size()));
  for (Eigen::Index i = 0; i < x.cols(); ++i)
    x.col(i) = Eigen::Map<const Eigen::Array4d>(set.sites[static_cast<std::size_t>(i)].features.data());
  for (Eigen::Index k = 0; k < 4; ++k) {
    const double mean = x.row(k).mean();
    const double low = x.row(k).minCoeff();
    const double high = x.row(k).maxCoeff();
    const double scale = std::sqrt((high - low) * 4.0 * std::sqrt((x.row(k) - mean).square().mean()));
    EXPECT_NEAR(set.normalisation.offset(k), mean, 1e-9 * scale);  // rounding of 5,000 terms
    EXPECT_NEAR(set.normalisation.scale(k), scale, 1e-9 * scale);
    EXPECT_EQ(set.normalisation.lower(k), low);
    EXPECT_EQ(set.normalisation.upper(k), high);
  }
}

TEST(TrainingSet, AConstantFeatureHasTheScaleOne) {
  const Recording recording = recording_of(1000, [](int i) { return std::pair{2e-3, 1.0 + 1e-3 * i}; });
  const TrainingSet set = set_of(recording, test::position_features(), Reduction::coverage);
  EXPECT_EQ(set.normalisation.scale(0), 1.0);
  EXPECT_NEAR(set.normalisation.offset(0), 2e-3, 1e-9);
  EXPECT_LE(set.sites.size(), 2u);  // the boundary of a cube is at the mean
}

TEST(TrainingSet, RefusesRecordingsWithoutContact) {
  MotionSource source = source_of(recording_of(100, [](int) { return std::pair{-1e-3, 0.0}; }));
  const auto set = make_training_set(source, test::position_features(), Reduction::coverage, 0.01);
  ASSERT_FALSE(set.ok());
  EXPECT_TRUE(test::has_parts(set.error().message, {"in contact (position_m > 0)"}));
}

}  // namespace
}  // namespace palpate
