// The data a fit works on: normalised feature vectors with the force measured
// at each (the pairs {u_i; f_i} of Hoever & Harders 2009, section 3).
// Thread guarantee: a value type; validate_sites may be called from any thread.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "engine/base/result.h"
#include "engine/tick/features.h"

namespace palpate {

inline constexpr int kMaxDimension = static_cast<int>(kMaxFeatures);

struct Sites {
  Eigen::MatrixXd points;    // d x N, normalised, one column a site, d from 1 to kMaxDimension
  Eigen::VectorXd target_N;  // N forces
  // N factors >= 0 that multiply the residual rows, e.g. 1 / JND(force). A
  // factor of 0 leaves the site out of the sum.
  Eigen::VectorXd row_scale;
  // What was decided about the correction by leaving strokes out
  // (models/fit/correction_strength.h): the penalty on its roughness, in place of
  // what a method would choose itself, and the share of it that the model gets.
  std::optional<double> smoothing;  // of the cubic kernel; others choose their own
  double strength = 1.0;
  // As Hoever & Harders (2009) solve: truncated singular values, even grids.
  bool as_2009 = false;

  Eigen::Index count() const { return points.cols(); }
  int dimension() const { return static_cast<int>(points.rows()); }
};

// Checks sizes and finiteness. Errors: names the array and the sizes found and
// expected, or the first site with a number that is not finite.
Status validate_sites(const Sites& sites);

// At most `most` of them, spread evenly over their order.
Sites even_subset(const Sites& sites, Eigen::Index most);

// Indices, ascending, of the sites left when of those at exactly the same point
// only the first is kept.
std::vector<Eigen::Index> distinct_sites(const Sites& sites);

}  // namespace palpate
