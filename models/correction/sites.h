// The data of a correction. A site is a normalised feature vector with its measured force (the pairs {u_i; f_i} of
// Hoever & Harders 2009, section 3) and the factor of its residual. Thread guarantee: value types and pure functions.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "engine/base/random_stream.h"
#include "engine/base/result.h"
#include "models/model/rbf/kernels.h"

namespace palpate {

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

  // Of sites from recordings; otherwise empty.
  Eigen::VectorXd force_N{};  // mean of the measured forces
  Eigen::VectorXd samples{};  // number of samples merged into the site
  std::vector<int> fold{};    // of the cross-validation (models/samples/samples.h)

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
