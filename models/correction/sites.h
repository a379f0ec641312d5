// The data of a correction, and how samples become sites by normalisation and thinning (models/METHOD.md, Features,
// normalisation, sites).
//
// Normalisation: u = (x - mean) / sqrt(range x 4 sigma) for each feature, over the samples in contact. The range alone
// would compress all slow motion after one fast poke; sigma alone would stretch the poke.
//
// Thinning, one of
//   coverage  all samples in a cube of the feature space, of one fold, with force or without, become one site
//             with their means (default). This thins rests, keeps every visited region and averages noise.
//   force     the reduction of the paper (section 2.1): a sample is kept when the force has changed by 50 mN
//   none      every sample in contact
// The step of each grows by a quarter while there are too many sites. Thread guarantee: slow side, pure.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "engine/base/random_stream.h"
#include "engine/base/result.h"
#include "models/model/correction.h"
#include "models/model/kernels.h"
#include "models/samples/samples.h"

namespace palpate {

struct Sites {
  Eigen::MatrixXd points;    // d x N, normalised, one column a site, 1 <= d <= kMaxFeatures
  Eigen::VectorXd target_N;  // N forces
  // N factors >= 0 that multiply the residuals, e.g. 1 / JND(force). With factor 0 a site has no influence.
  Eigen::VectorXd row_scale;
  KernelKind kernel = KernelKind::cubic;
  // Factor of the roughness penalty: the ratio of noise variance to prior variance, which does not depend on the number
  // of centres. A fit selects it by cross-validation (models/fit/residual_rows.h).
  double smoothing = 0.0;
  // Above 0: the weights of centres are those of Hoever & Harders (2009), by a pseudo-inverse without the singular
  // values below this share of the largest, instead of the penalty.
  double truncation = 0.0;

  // Of sites from recordings; otherwise empty.
  Eigen::VectorXd force_N{};  // mean of the measured forces
  Eigen::VectorXd samples{};  // number of samples merged into the site
  std::vector<int> fold{};    // of the cross-validation (models/samples/samples.h)

  Eigen::Index count() const { return points.cols(); }
  int dimension() const { return static_cast<int>(points.rows()); }
};

// What is fitted to sites: the correction, and how well its weights are determined.
struct FittedCorrection {
  CorrectionPtr correction;
  std::vector<std::string> notes{};  // sentences for the user
  Eigen::Index rank = 0;             // of the weights' equations: singular values or rows that are used; 0: none
  double condition_number = 0.0;     // the largest singular value of these equations over the smallest; 0: none

  // Of a correction with centres.
  const RbfFunction& function() const { return *rbf_of(correction); }
};

// Errors: a number is not finite.
Status validate_sites(const Sites& sites);
// At most `most` of the sites, spread evenly over their order.
Sites even_subset(const Sites& sites, Eigen::Index most);
// Indices, ascending, of the sites without duplicates: of sites at exactly the same point the first is kept.
std::vector<Eigen::Index> distinct_sites(const Sites& sites);
// Draws up to `most` of the indices without replacement and moves them to the front (Fisher & Yates). Returns the
// number of drawn ones.
std::size_t draw_first(std::vector<Eigen::Index>& indices, Eigen::Index most, SplitMix64& random);

// The step of the paper's reduction, which separates no forces below it.
inline constexpr double kReductionForce_N = 0.05;

enum class Thinning { coverage, force, none };
// In commands and model files, in the order of the values.
inline constexpr std::array<const char*, 3> kThinningNames{"coverage", "force", "none"};

inline constexpr std::size_t kMaximumSites = 10000;
inline constexpr std::size_t kCoverageSites = 7500;  // the paper worked with 6,850
inline constexpr double kCoverageStep = 0.005;       // at the start, in normalised feature space

// `features`: at the samples in contact, one column each, SI.
Normalisation normalisation_of(const Eigen::MatrixXd& features);
// The sites without targets and row scales, with normalised points. `step_N`: receives the step of Thinning::force.
Sites thin(const Samples& samples, const Eigen::MatrixXd& features, const Normalisation& normalisation,
           Thinning thinning, double& step_N);

}  // namespace palpate
