// How near a query is to a set of points: the distance to the nearest, and whether any
// is within a radius that is known beforehand.
//
// Points are stored and compared in single precision: the distance is off by at most
// 3e-7 (|x| + largest |point|) + 1e-10, and "within" says yes only where the distance
// would say so. What it leaves out for that is a share of 1e-5 of the squared distance
// from the middle of the points.
// Thread guarantee: immutable; queries are wait-free and allocate nothing, any thread.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "models/model/nearest_simd.h"

namespace palpate {

class NearestDistance {
 public:
  // `points`: d x N, d from 1 to kMaxFeatures, N >= 1.
  explicit NearestDistance(const Eigen::MatrixXd& points);

  // min_i |x - point_i|^2, O(N); infinite when x is not finite or further than 1e19 away.
  double nearest_squared(const double* x) const noexcept;

 private:
  std::shared_ptr<const float[]> memory_;
  std::size_t stride_ = 0;
  int dimension_ = 0;
  simd::NearestFunction nearest_ = nullptr;
};

// A tree of five median splits, each with some points of the other half beside its own,
// and a query looks at the points of one leaf only: on recordings 1 to 6 of a thousand
// that are near some point do not find it there (14 with six features), where leaves
// without such an overlap fail 28 to 200. Nothing branches on the way.
class NearPoints {
 public:
  // `points` as above.
  NearPoints(const Eigen::MatrixXd& points, double radius);

  // The leaf of x, for `found`.
  const float* leaf(const double* x) const noexcept { return loops_.leaf(tree_, x); }
  // True: some point is no further than the radius. False: the distance has to say.
  bool found(const double* x, const float* leaf_of_x) const noexcept { return loops_.near(tree_, leaf_of_x, x); }

 private:
  void split(const Eigen::MatrixXd& points, std::vector<Eigen::Index> part, std::size_t node,
             std::vector<std::vector<Eigen::Index>>& leaves);
  void set_limit(double radius, double largest, double about_squared);

  std::shared_ptr<float[]> leaves_;
  simd::NearTree tree_;
  simd::NearestLoops loops_;
};

}  // namespace palpate
