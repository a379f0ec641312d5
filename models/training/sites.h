// The data of a fit: normalised feature vectors with the force measured at each (the pairs {u_i; f_i} of Hoever &
// Harders 2009, section 3).
// Thread guarantee: a value type; validate_sites may be called from any thread.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "engine/base/random_stream.h"
#include "engine/base/result.h"
#include "engine/tick/features.h"

namespace palpate {

struct Sites {
  Eigen::MatrixXd points;    // d x N, normalised, one column a site, 1 <= d <= kMaxFeatures
  Eigen::VectorXd target_N;  // N forces
  // N factors >= 0 that multiply the residuals, e.g. 1 / JND(force). With factor 0 a site has no influence.
  Eigen::VectorXd row_scale;
  // Both selected by cross-validation (models/fit/model_validation.h).
  std::optional<double> smoothing;  // roughness penalty of the cubic kernel; empty: the method selects it
  double strength = 1.0;            // factor of the correction, 0 to 1
  // Solve as Hoever & Harders (2009): truncated singular values, even grids.
  bool as_2009 = false;

  Eigen::Index count() const { return points.cols(); }
  int dimension() const { return static_cast<int>(points.rows()); }
};

// Errors: a number is not finite.
Status validate_sites(const Sites& sites);

// At most `most` of the sites, spread evenly over their order.
Sites even_subset(const Sites& sites, Eigen::Index most);

// Indices, ascending, of the sites without duplicates: of sites at exactly the same point the first is kept.
std::vector<Eigen::Index> distinct_sites(const Sites& sites);

// Draws up to `most` of the indices without replacement and brings them to the front (Fisher & Yates). Returns how many
// were drawn.
std::size_t draw_first(std::vector<Eigen::Index>& indices, Eigen::Index most, SplitMix64& random);

}  // namespace palpate
