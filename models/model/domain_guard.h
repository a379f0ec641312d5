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
#include <atomic>
#include <cstdint>

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

// The distance of a query to the nearest of a set of points, which are in cells. A query first examines the cell of the
// last one, so that one in a stream of ticks seldom examines another; the result does not depend on that.
class NearestDistance {
 public:
  // `points`: d x N, d from 1 to kMaxFeatures, N >= 1.
  explicit NearestDistance(const Eigen::MatrixXd& points);

  // min_i |x - point_i|^2, or 0 if that is at most `enough`; infinite when x is not finite or has a coordinate beyond
  // 1e19. O(N) at worst.
  double squared(const double* x, float enough = -1.0F) const noexcept;

 private:
  std::size_t dimension_;
  Eigen::MatrixXf points_, low_, high_;  // of simd::Cells
  decltype(simd::Loops::nearest) nearest_ = nullptr;
  mutable std::atomic<std::uint32_t> last_cell_{0};  // a hint
};

// The trust around a cover.
class DomainGuard {
 public:
  explicit DomainGuard(const DomainCover& cover);

  // `x`: d normalised values. Returns g in [0, 1]; 0 when x is not finite.
  double trust(const double* x) const noexcept { return trust_at(squared_distance(x)); }
  // The squared distance to the cover; 0 within the inner radius, where the trust is 1 and the error bound does not
  // grow; infinite when x is not finite.
  double squared_distance(const double* x) const noexcept { return points_.squared(x, near_squared_); }
  double trust_at(double squared_distance) const noexcept;

 private:
  double inner_radius_, outer_radius_;
  float near_squared_;  // at most the square of the inner radius
  NearestDistance points_;
};

}  // namespace palpate
