// From recordings to sites: features, normalisation and thinning.
//
// Normalisation: u = (x - mean) / sqrt(range x 4 sigma) for each feature, over the samples in contact. The range alone
// would compress all slow motion after one fast poke; sigma alone would stretch the poke. Their geometric mean had the
// lowest errors on recordings that were not used for training.
//
// Thinning, one of
//   coverage  the feature space is divided into cubes of side `step`; all samples of a cube become one site with their
//             mean feature vector and mean force (default). This thins rests, keeps every visited region and averages
//             noise. The step starts at kCoverageStep and grows by a quarter while there are more than kCoverageSites.
//   force     the reduction of the paper (section 2.1): a sample is kept when the force has changed by 50 mN since the
//   last kept
//             one. The 50 mN grow by a quarter while there are more than kMaximumSites.
//   none      every sample in contact
//
// In `coverage`, a site has samples of one fold only (cross_validation.h). Samples without measured force form sites of
// their own, which are marked, because contact is one-sided.
// Thread guarantee: slow side.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "engine/base/result.h"
#include "engine/tick/features.h"
#include "models/training/motion_source.h"

namespace palpate {

enum class Thinning { coverage, force, none };
// In commands and model files, in the order of the values.
inline constexpr std::array<const char*, 3> kThinningNames{"coverage", "force", "none"};

inline constexpr std::size_t kMaximumSites = 10000;
inline constexpr std::size_t kCoverageSites = 7500;  // the paper worked with 6,850
inline constexpr double kCoverageStep = 0.005;       // at the start, in normalised feature space
inline constexpr std::size_t kMaximumEvaluationSamples = 100000;

struct Normalisation {
  Eigen::VectorXd offset;  // SI
  Eigen::VectorXd scale;   // SI, > 0; 1 for a feature that never changes
  Eigen::VectorXd lower;   // bounds in contact, SI
  Eigen::VectorXd upper;
};

struct TrainingSite {
  std::array<double, kMaxFeatures> features{};  // SI
  double force_N = 0.0;
  double count = 1.0;  // number of samples merged into it
  int recording = 0;
  int fold = 0;
  bool no_force = false;  // magnitude at or below the noise floor, which shows only that the force is not positive
};

struct TrainingSet {
  Normalisation normalisation;
  std::vector<TrainingSite> sites;
  std::size_t contact_samples = 0;
  double thinning_force_N = 0.0;  // final step of Thinning::force
  // Evenly spaced samples in contact, to evaluate a model on its training data: at most kMaximumEvaluationSamples.
  std::vector<std::array<double, kMaxFeatures>> evaluation_features;
  std::vector<double> evaluation_force_N;
  std::vector<int> evaluation_fold;
};

// `force_noise_floor_N`: at or below this magnitude a sample has no measured force. Errors: no sample in contact;
// interrupted.
Result<TrainingSet> make_training_set(MotionSource& source, const std::vector<FeatureSpec>& features, Thinning thinning,
                                      double force_noise_floor_N, const FitControl& control = {});

}  // namespace palpate
