// The distance of a feature vector from the data of a model, and the trust in the correction there. The domain is the
// neighbourhood of the recorded samples in the normalised feature space, not their bounding box, which is mostly empty.
// The guard stores the cover, a thinned set of the sites that has every site well within inner_radius, and gives the
// trust g(x): 1 for distance <= inner_radius, 0 for distance >= outer_radius, smoothstep between, with slope at most
// 1.5 / (outer - inner). Points are compared in single precision; the error of a distance is at most
// 3e-7 (|x| + largest |point|) + 1e-10.
// Thread guarantee: immutable; queries are wait-free and allocate nothing, any thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "engine/tick/features.h"
#include "models/model/vector_loops.h"

namespace palpate {

inline constexpr Eigen::Index kMaximumCoverPoints = 768;

struct DomainCover {
  Eigen::MatrixXd points;  // d x M, normalised
  double inner_radius = 0.0, outer_radius = 0.0;
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
  // Whether a point is within the distance whose square is `squared`. `rounded`: x by nearest_float (vector_loops.h).
  bool within(const float* rounded, float squared) const noexcept {
    return loops_.within(rows_.data(), static_cast<std::size_t>(rows_.rows()), rounded, squared);
  }

 private:
  Eigen::MatrixXf rows_;  // one column for each coordinate, padded
  simd::Loops loops_;
};

// The trust around a cover. A query examines the points of one leaf of a tree of five median splits; if none of them is
// within the inner radius, it examines all points, so the result does not depend on the tree. Nearly all queries of a
// tick end in their leaf. O(points) at worst.
class DomainGuard {
 public:
  explicit DomainGuard(const DomainCover& cover);

  // `x`: d normalised values. Returns g in [0, 1]; 0 when x is not finite.
  double trust(const double* x) const noexcept { return trust_at(squared_distance(x, leaf(x))); }

  // The squared distance to the cover; infinite when x is not finite. Within the inner radius, where the trust is 1 and
  // the error bound does not grow, it may be 0. There are two steps, so that the tick can do other work in between.
  struct Leaf {
    std::array<float, kMaxFeatures> rounded;  // x
    const NearestDistance* points;
  };
  Leaf leaf(const double* x) const noexcept {
    Leaf leaf;
    leaf.points = &leaves_[leaf_(splits_, x, leaf.rounded.data())];
    return leaf;
  }
  double squared_distance(const double* x, const Leaf& leaf_of_x) const noexcept {
    return leaf_of_x.points->within(leaf_of_x.rounded.data(), near_squared_) ? 0.0 : all_.nearest_squared(x);
  }
  double trust_at(double squared_distance) const noexcept;

 private:
  void split(const Eigen::MatrixXd& points, std::vector<Eigen::Index> part, std::size_t node);

  double inner_radius_ = 0.0, outer_radius_ = 0.0;
  float near_squared_ = 0.0F;  // at most the square of the inner radius
  NearestDistance all_;
  simd::Splits splits_;
  std::vector<NearestDistance> leaves_;
  decltype(simd::Loops::leaf) leaf_ = nullptr;
};

}  // namespace palpate
