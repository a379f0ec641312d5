#include "models/correction/methods.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

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

Samples samples_of(const Recording& recording) {
  return test::must(make_samples({prepare_recording(recording)}, JndLine{}));
}

struct Thinned {
  Normalisation normalisation;
  Sites sites;
  double step_N = 0.0;

  double force_N(Eigen::Index site) const { return sites.force_N(site); }
  Eigen::VectorXd features(Eigen::Index site) const {
    return normalisation.offset + normalisation.scale.cwiseProduct(sites.points.col(site));
  }
};

Thinned thinned_by(Thinning thinning, const Samples& samples, const std::vector<FeatureSpec>& specs) {
  const Eigen::MatrixXd features = test::must(features_at(samples, specs, samples.contact));
  Thinned result{normalisation_of(features), {}};
  result.sites = thin(samples, features, result.normalisation, thinning, result.step_N);
  EXPECT_EQ(result.sites.points.rows(), static_cast<Eigen::Index>(specs.size()));
  EXPECT_EQ(result.sites.force_N.size(), result.sites.count());
  EXPECT_EQ(result.sites.fold.size(), static_cast<std::size_t>(result.sites.count()));
  return result;
}

// The tool rests at ten positions, and the only feature is depth: ten sites, each with the mean of its
// samples. The positions are unevenly spaced, because equal spaces would look like encoder steps.
TEST(Thinning, ASiteIsTheMeanOfItsCube) {
  const Samples samples = samples_of(recording_of(5000, [](int i) {
    const int place = i / 500;
    return std::pair{1e-3 * (1 + place) + 2e-4 * std::sin(place), 1.0 + i / 500 + (i % 2 == 0 ? 0.1 : -0.1)};
  }));
  const Thinned thinned = thinned_by(Thinning::coverage, samples, test::position_features());
  const Eigen::VectorXd& counts = thinned.sites.samples;
  EXPECT_EQ(counts.sum(), 5000.0);
  EXPECT_NEAR(counts.dot(thinned.sites.force_N) / 5000.0, 5.5, 1e-9);  // mean of 1 to 10; rounding of running means
  EXPECT_NEAR(thinned.sites.points.row(0).dot(counts) / 5000.0, 0.0, 1e-9);
  int large = 0;
  for (Eigen::Index i = 0; i < counts.size(); ++i) {
    if (counts(i) < 60.0)
      continue;  // during the transient of the motion estimator; a place has pieces of several folds
    ++large;
    EXPECT_NEAR(thinned.force_N(i), std::round(thinned.force_N(i)), 2e-3);
  }
  EXPECT_GE(large, 8);  // a rest position may be on the boundary of a cube
}

// Twenty presses of one path, of which every fifth has other forces.
TEST(Thinning, ASiteHasSamplesOfOneFoldOnly) {
  const Samples samples = samples_of(recording_of(10000, [](int i) {
    const double position_m = 3e-3 * std::sin(2.0 * M_PI * i / 500.0);
    const bool first_fold = i / 500 % 5 == 0;
    return std::pair{position_m, position_m > 0.0 ? (first_fold ? 2.0 : 1.0) : 0.0};
  }));
  ASSERT_EQ(samples.stroke.back(), 20);
  const Thinned thinned = thinned_by(Thinning::coverage, samples, test::position_features());
  for (Eigen::Index i = 0; i < thinned.sites.count(); ++i) {
    const bool first_fold = thinned.sites.fold[static_cast<std::size_t>(i)] == 0;
    EXPECT_NEAR(thinned.force_N(i), first_fold ? 2.0 : 1.0, 1e-12) << "a mean of equal numbers";
  }
}

TEST(Thinning, ForceReductionKeepsThePapersSamples) {
  const Recording recording = recording_of(3000, [](int i) {
    return std::pair{3e-3 + 1e-3 * std::sin(0.01 * i), 2.0 + std::sin(0.01 * i) + 0.02 * std::sin(0.7 * i)};
  });
  const Thinned thinned = thinned_by(Thinning::force, samples_of(recording), test::position_features());
  std::vector<double> expected_N;
  for (const RecordingRow& row : recording.rows) {
    if (expected_N.empty() || std::abs(row.force_N - expected_N.back()) >= 0.05) expected_N.push_back(row.force_N);
  }
  EXPECT_EQ(std::vector<double>(thinned.sites.force_N.begin(), thinned.sites.force_N.end()), expected_N);
  EXPECT_EQ(thinned.sites.samples, Eigen::VectorXd::Ones(thinned.sites.count()));
  EXPECT_EQ(thinned.step_N, 0.05);
}

}  // namespace
}  // namespace palpate
