// The distance of a feature vector from the data of a model, and the trust in the correction there.
//
// The domain is the neighbourhood of the recorded samples in the normalised feature space, not their bounding box: the
// box of a few strokes is mostly empty, and errors of radial basis functions in it reached twice the largest force.
// The guard stores a thinned set of the sites, the cover, with every site well within inner_radius of it, and gives
//
//   trust g(x) = 1                 for distance <= inner_radius
//              = smoothstep        between
//              = 0                 for distance >= outer_radius
//
// The distance to a set is Lipschitz continuous with constant 1, so g is continuous, with slope at most
// 1.5 / (outer - inner).
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
  explicit DomainGuard(const DomainCover& cover);

  // `x`: d normalised values. Returns g in [0, 1]; 0 when x is not finite.
  double trust(const double* x) const noexcept { return trust_at(squared_distance(x, leaf(x))); }

  // The squared distance to the cover; infinite when x is not finite. Within the inner radius, where the trust is 1
  // and the error bound does not grow, it may be 0 instead. In two steps, so that the tick can interleave other work.
  const float* leaf(const double* x) const noexcept { return near_.leaf(x); }
  double squared_distance(const double* x, const float* leaf_of_x) const noexcept {
    return near_.found(x, leaf_of_x) ? 0.0 : nearest_.nearest_squared(x);
  }
  double trust_at(double squared_distance) const noexcept;

 private:
  double inner_radius_ = 0.0;
  double outer_radius_ = 0.0;
  NearPoints near_;
  NearestDistance nearest_;
};

}  // namespace palpate
