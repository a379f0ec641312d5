// The distance of a query to the nearest of a set of points, and a faster test whether it is within a fixed radius.
//
// Points are stored and compared in single precision. The error of the distance is at most
// 3e-7 (|x| + largest |point|) + 1e-10, and the test is positive only if the exact distance is within the radius.
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

  // min_i |x - point_i|^2, O(N); infinite when x is not finite or has a coordinate beyond 1e19.
  double nearest_squared(const double* x) const noexcept;

 private:
  Eigen::MatrixXf rows_;  // padded
  simd::NearestFunction nearest_ = nullptr;
};

// A tree of five median splits whose halves overlap by some points. A query examines the points of one leaf only: of a
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

}  // namespace palpate
