// How much each site, taken as the next centre, would lower the squared error,
// given the basis chosen so far: (c . r)^2 / |c'|^2, where c is the site's
// scaled kernel column, c' its part outside the basis and r the residual.
//
// What was once found out of a site is kept: a basis only grows, so a site that
// comes up again owes no more than its shares of the directions added since.
//
// |c'|^2 = |c|^2 - |Q^T c|^2 loses its digits when c lies almost inside the
// basis. Sums of N products are good to some 1e-14 of |c|^2; where less than
// 1e-11 is left of the last value known in full, c' itself is computed, many
// columns at a time, and a site with |c'| <= 1e-10 |c| has no gain. A gain is so
// known to better than 1 %, far below any difference that matters to a choice.
// Thread guarantee: one object, one thread; it starts others itself.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "models/model/rbf/rbf_evaluate.h"
#include "models/solve/orthogonal_basis.h"

namespace palpate {

inline constexpr double kCancelled = 1e-11;    // of a square: compute the column's part below this
inline constexpr double kInsideBasis = 1e-20;  // of a square: no use below this

class CandidateGains {
 public:
  // `sites` must outlive this.
  CandidateGains(const Sites& sites, KernelKind kernel);

  // The scaled kernel column of a centre at a site, N values.
  Eigen::VectorXd column(Eigen::Index site) const;

  // Brings these sites, each named once, up to the basis, which is always the same
  // one, grown since the last call. O(N new directions) for each.
  void update(std::span<const Eigen::Index> sites, const OrthogonalBasis& basis);
  // The same for sites that are up to date but for the last direction, q, of
  // which `along` has every site's share and which took `residual_share` = q . r
  // from the residual. O(1) for each.
  void advance(std::span<const Eigen::Index> sites, const OrthogonalBasis& basis, const Eigen::VectorXd& along,
               double residual_share);
  // Takes what the column itself says of a site.
  void correct(Eigen::Index site, const OrthogonalBasis::Outside& part);

  double gain(Eigen::Index site) const {
    const double outside = outside_squared_[site];
    return outside > 0.0 ? correlation_[site] * correlation_[site] / outside : 0.0;
  }
  // Whether `part` of the site's column is worth a direction of its own.
  bool useful(Eigen::Index site, const OrthogonalBasis::Outside& part) const {
    return part.squared > kInsideBasis * length_squared_[site];
  }

 private:
  Eigen::MatrixXd columns(std::span<const Eigen::Index> sites) const;
  void add_shares(std::span<const Eigen::Index> sites, const OrthogonalBasis& basis);
  void recompute_cancelled(std::span<const Eigen::Index> sites, const OrthogonalBasis& basis);

  const Sites& sites_;
  KernelKind kernel_;
  PointArrays points_;
  // By site; lengths and what follows from them only where known_to_ > 0.
  std::vector<Eigen::Index> known_to_;  // directions that outside_squared_ takes into account
  Eigen::VectorXd length_squared_;      // |c|^2
  Eigen::VectorXd outside_squared_;     // |c'|^2, 0 when the site is of no use
  Eigen::VectorXd exact_squared_;       // outside_squared_ when it was last computed in full
  Eigen::VectorXd correlation_;         // c . r
};

}  // namespace palpate
