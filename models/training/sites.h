// The data of a fit. A site is a normalised feature vector with its measured force (the pairs {u_i; f_i} of Hoever &
// Harders 2009, section 3) and the factor of its residual.
// Thread guarantee: value types and pure functions.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "engine/base/random_stream.h"
#include "engine/base/result.h"
#include "engine/tick/features.h"
#include "engine/tick/jnd.h"
#include "models/model/rbf/kernels.h"

namespace palpate {

// The factor of a residual.
enum class Weighting {
  jnd,       // 1 / JND(f), errors relative to perception (default)
  relative,  // 1 / max(|f|, kReductionForce_N), eq. (8) of the paper
  none,      // 1
};

// Names in commands and model files, in the order of the values.
inline constexpr std::array<const char*, 3> kWeightingNames{"jnd", "relative", "none"};

// The step of the paper's reduction (training_set.h), below which it separates no forces: 1 / |f| is constant there.
inline constexpr double kReductionForce_N = 0.05;

inline double row_scale(Weighting weighting, const JndLine& jnd, double force_N) noexcept {
  if (weighting == Weighting::none) return 1.0;
  return 1.0 / (weighting == Weighting::jnd ? jnd.at(force_N) : std::max(std::abs(force_N), kReductionForce_N));
}

// The factor robust_scale is the square root of the weight of a Cauchy likelihood (Holland & Welsch 1977): 1 for small
// errors, less for errors well above the JND, which would otherwise bend the fit elsewhere.
inline constexpr double kRobustError_jnd = 2.0;

inline double robust_scale(double error_over_jnd) noexcept {
  const double share = error_over_jnd / kRobustError_jnd;
  return 1.0 / std::sqrt(1.0 + share * share);
}

struct Sites {
  Eigen::MatrixXd points;    // d x N, normalised, one column a site, 1 <= d <= kMaxFeatures
  Eigen::VectorXd target_N;  // N forces
  // N factors >= 0 that multiply the residuals, e.g. 1 / JND(force). With factor 0 a site has no influence.
  Eigen::VectorXd row_scale;
  KernelKind kernel = KernelKind::cubic;
  // Factor of the roughness penalty: the ratio of noise variance to prior variance, which does not depend on the number
  // of centres. A fit selects it by cross-validation (models/fit/correction_choice.h).
  double smoothing = 0.0;
  // Above 0: the weights of centres are those of Hoever & Harders (2009), by a pseudo-inverse without the singular
  // values below this share of the largest, instead of the penalty.
  double truncation = 0.0;

  Eigen::Index count() const { return points.cols(); }
  int dimension() const { return static_cast<int>(points.rows()); }
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

}  // namespace palpate
