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
// Points are stored and compared in single precision. The error of a distance is at most
// 3e-7 (|x| + largest |point|) + 1e-10.
// Thread guarantee: immutable; queries are wait-free and allocate nothing, any thread.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "models/model/nearest_simd.h"

namespace palpate {

inline constexpr Eigen::Index kMaximumCoverPoints = 768;

struct DomainCover {
  Eigen::MatrixXd points;  // d x M, normalised
  double inner_radius = 0.0;
  double outer_radius = 0.0;
};

// The trust g at a distance from the cover.
double trust_at_distance(double distance, double inner_radius, double outer_radius) noexcept;

// Thins `sites` (d x N, N >= 1) to a cover of at most kMaximumCoverPoints points.
DomainCover make_cover(const Eigen::MatrixXd& sites);

// The distance of a query to the nearest of a set of points.
class NearestDistance {
 public:
  // `points`: d x N, d from 1 to kMaxFeatures, N >= 1.
  explicit NearestDistance(const Eigen::MatrixXd& points);

  // min_i |x - point_i|^2, O(N); infinite when x is not finite or has a coordinate beyond 1e19.
  double nearest_squared(const double* x) const noexcept;

 private:
  Eigen::MatrixXf rows_;  // padded
  simd::NearestFunction nearest_ = nullptr;
};

// A faster test whether a query is within a fixed radius of a point; positive only if the exact distance is. It is a
// tree of five median splits whose halves overlap by some points. A query examines the points of one leaf only: of a
// thousand queries on recordings that are near a point, 1 to 6 are not found (14 with six features); without the
// overlap it would be 28 to 200. The descent has no branches.
class NearPoints {
 public:
  // `points` as above.
  NearPoints(const Eigen::MatrixXd& points, double radius);

  // The leaf of x, for `found`.
  const float* leaf(const double* x) const noexcept { return loops_.leaf(tree_, x); }
  // True: a point is within the radius. False: the distance must be computed.
  bool found(const double* x, const float* leaf_of_x) const noexcept { return loops_.near(tree_, leaf_of_x, x); }

 private:
  void split(const Eigen::MatrixXd& points, std::vector<Eigen::Index> part, std::size_t node,
             std::vector<std::vector<Eigen::Index>>& leaves);
  void set_limit(double radius, double largest, double about_squared);

  std::shared_ptr<const Eigen::MatrixXf> leaves_;  // one a column; shared by copies, because tree_ points to it
  simd::NearTree tree_;
  simd::NearestLoops loops_;
};

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
