// From samples to sites: normalisation and thinning.
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
//             last kept one. The 50 mN grow by a quarter while there are more than kMaximumSites.
//   none      every sample in contact
//
// In `coverage`, a site has samples of one fold only. Samples without measured force form sites of their own, because
// contact is one-sided.
// Thread guarantee: slow side, pure.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "models/correction/sites.h"
#include "models/samples/samples.h"

namespace palpate {

enum class Thinning { coverage, force, none };
// In commands and model files, in the order of the values.
inline constexpr std::array<const char*, 3> kThinningNames{"coverage", "force", "none"};

inline constexpr std::size_t kMaximumSites = 10000;
inline constexpr std::size_t kCoverageSites = 7500;  // the paper worked with 6,850
inline constexpr double kCoverageStep = 0.005;       // at the start, in normalised feature space

struct Normalisation {
  Eigen::VectorXd offset;  // SI
  Eigen::VectorXd scale;   // SI, > 0; 1 for a feature that never changes
  Eigen::VectorXd lower;   // bounds in contact, SI
  Eigen::VectorXd upper;

  // Upper minus lower bound; 0 at the level of rounding.
  double range(Eigen::Index feature) const;
  // The scale range^a (4 sigma)^(1 - a) of each feature; a = 1/2 gives `scale`.
  Eigen::VectorXd scale_of(double range_exponent) const;
};

// `features`: at the samples in contact, one column each, SI.
Normalisation normalisation_of(const Eigen::MatrixXd& features);

// The sites without targets and row scales, with normalised points. `step_N`: receives the step of Thinning::force.
Sites thin(const Samples& samples, const Eigen::MatrixXd& features, const Normalisation& normalisation,
           Thinning thinning, double& step_N);

}  // namespace palpate
