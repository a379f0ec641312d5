// How near a feature vector is to the data that a model was fitted to.
//
// "Inside" means near a recorded sample in the normalised feature space, not
// inside the bounding box: a box around a few strokes is mostly empty, and
// radial basis functions were seen to be wrong by twice the largest force in
// it. The guard keeps a thinned set of the sites ("cover": no site is further
// than `cover_radius` from one of its points) and gives
//
//   trust g(x) = 1                 for distance <= inner_radius
//              = smoothstep        between
//              = 0                 for distance >= outer_radius
//
// The distance to a set of points changes no faster than the query moves, so g
// is continuous, with slope at most 1.5 / (outer - inner).
//
// Thread guarantee: immutable; `trust` is wait-free and allocates nothing.
#pragma once

#include <Eigen/Core>

#include "models/model/nearest_points.h"

namespace palpate {

inline constexpr Eigen::Index kMaximumCoverPoints = 768;

struct DomainCover {
  Eigen::MatrixXd points;  // d x M, normalised
  double inner_radius = 0.0;
  double outer_radius = 0.0;
};

// Thins `sites` (d x N, N >= 1) to a cover of at most kMaximumCoverPoints points.
DomainCover make_cover(const Eigen::MatrixXd& sites);

class DomainGuard {
 public:
  explicit DomainGuard(DomainCover cover);

  // `x`: d normalised values. Returns g in [0, 1]; 0 when x is not finite.
  double trust(const double* x) const noexcept { return trust_at(squared_distance(x)); }

  // The squared distance to the cover, infinite when x is not finite, and the trust
  // that goes with it. Within the inner radius, where trust is whole and the error bound
  // does not grow, it is not told: there 0 may stand for it.
  double squared_distance(const double* x) const noexcept { return squared_distance(x, leaf(x)); }
  // The same in two halves, for who has something to do between them.
  const float* leaf(const double* x) const noexcept { return near_.leaf(x); }
  double squared_distance(const double* x, const float* leaf_of_x) const noexcept {
    return near_.found(x, leaf_of_x) ? 0.0 : nearest_.nearest_squared(x);
  }
  double trust_at(double squared_distance) const noexcept;

  const DomainCover& cover() const noexcept { return cover_; }

 private:
  DomainCover cover_;
  double inner_squared_ = 0.0;
  NearPoints near_;
  NearestDistance nearest_;
};

}  // namespace palpate
