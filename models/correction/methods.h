// The table of methods. All code that offers, fits, draws or times methods iterates over `methods()`. A new method is
// one source file that defines its row and its fit, and its name here and in the table of methods.cpp. It computes the
// correction of a model (models/model/correction.h) from the sites; models/fit does the rest.
// Thread guarantee: rows are constants; the functions are slow side.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/random_stream.h"
#include "engine/base/result.h"
#include "models/model/correction.h"
#include "models/model/kernels.h"
#include "models/samples/samples.h"

namespace palpate {

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

struct Sites {
  Eigen::MatrixXd points;    // d x N, normalised, one column a site, 1 <= d <= kMaxFeatures
  Eigen::VectorXd target_N;  // N forces
  // N factors >= 0 that multiply the residuals, e.g. 1 / JND(force). With factor 0 a site has no influence.
  Eigen::VectorXd row_scale;
  KernelKind kernel = KernelKind::cubic;
  // Factor of the roughness penalty: the ratio of noise variance to prior variance, which does not depend on the number
  // of centres. A fit selects it by cross-validation.
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
// A quarter of the indices below `count`, at least one and at most `most`, always the same: centres for a choice.
std::vector<Eigen::Index> random_quarter(Eigen::Index count, Eigen::Index most);

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

struct Method;
extern const Method kTrendMethod, kDirectMethod, kVoxelMethod, kRandomMethod, kKdTreeMethod, kGreedyMethod;

// The input of a method; each uses the parameters that its row names in `takes`. References must be valid during the
// call.
struct MethodTask {
  const Sites& sites;            // normalised
  const Eigen::VectorXd& jnd_N;  // threshold at each site, > 0
  int centres = 100;
  int candidates = 100;     // per greedy step; 0: every site
  std::vector<int> grid{};  // nodes per feature; empty: 25 for depth (200 if alone), 11 for others, fewer beyond four
  std::uint64_t seed = 1;
  CorrectionPtr base{};  // fit of the row's base; null: none
};

enum MethodOption : unsigned {
  kTakesCentres = 1U << 0,
  kTakesCandidates = 1U << 1,
  kTakesGrid = 1U << 2,
  kTakesKernel = 1U << 3,
  kTakesSeed = 1U << 4,
};

// The colour of items without a hue of their own: drawn black on white and white on black.
inline constexpr std::uint32_t kNeutralColour = 0x000000;

struct Method {
  const char* name = "";                  // in commands, files and scenes
  std::uint32_t colour = kNeutralColour;  // 0xRRGGBB, the same in all figures
  unsigned takes = 0;                     // MethodOption flags
  // The method whose fit this one starts from, or null.
  const Method* base = nullptr;
  // Approximate time of a fit with default options without the base, on one core of 2023 with 7,000 sites: for progress
  // lines, and to fit the fastest method first.
  double expected_seconds = 0.0;
  // To be called by fit_correction. Errors: the sites cannot be fitted (says why); interrupted. Deterministic.
  Result<FittedCorrection> (*fit)(const MethodTask& task, const FitControl& control) = nullptr;

  bool can_take(MethodOption option) const { return (takes & option) != 0; }
};

// In the order of reports and lists.
const std::vector<const Method*>& methods();
// The sum for the method and its base.
double expected_seconds(const Method& method);
// Fits the method, and before it its base if the task has none. Errors: those of validate_sites and of the method.
Result<FittedCorrection> fit_correction(const Method& method, const MethodTask& task, const FitControl& control = {});
// For methods that select centres (d x n): their weights (models/correction/algebra.h). `shortage`: why there are
// fewer than planned. Errors: the weights could not be computed.
Result<FittedCorrection> fit_centres(const MethodTask& task, const Eigen::MatrixXd& centres,
                                     const std::string& shortage);

}  // namespace palpate
