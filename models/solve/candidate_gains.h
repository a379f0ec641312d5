// The gain of each site as the next centre: the decrease (c . r)^2 / |c'|^2 of the squared error, given the basis
// selected so far. c is the site's scaled kernel column, c' its part orthogonal to the basis and r the residual.
//
// The squares |c'|^2 are stored: the basis only grows, so an update subtracts only the components along the directions
// that are new to the site.
//
// |c'|^2 = |c|^2 - |Q^T c|^2, with the basis Q, suffers from cancellation when c is almost in the span of the basis.
// Sums of N products are accurate to some 1e-14 of |c|^2. Below 1e-11 of the last fully computed value, c' itself is
// computed, for many columns at a time, and a site with |c'| <= 1e-10 |c| has gain 0. Gains are thus accurate to better
// than 1 %, far below any difference that matters for the selection.
// Thread guarantee: one object, one thread; it starts others itself.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "models/model/rbf/rbf_evaluate.h"
#include "models/solve/orthogonal_basis.h"

namespace palpate {

inline constexpr double kCancelled = 1e-11;    // relative to the last full |c'|^2: below this c' is computed
inline constexpr double kInsideBasis = 1e-20;  // relative to |c|^2: below this the gain is 0

class CandidateGains {
 public:
  // `sites` must outlive this.
  CandidateGains(const Sites& sites, KernelKind kernel);

  // The scaled kernel column of a centre at a site, N values.
  Eigen::VectorXd column(Eigen::Index site) const;

  // Updates these distinct sites to the current basis, which must be that of the last call or grown from it. O(N new
  // directions) for each.
  void update(std::span<const Eigen::Index> sites, const OrthogonalBasis& basis);
  // The same for sites that lack only the last direction q, in O(1) for each. `along`: q . c of all sites.
  // `residual_share`: q . r.
  void advance(std::span<const Eigen::Index> sites, const OrthogonalBasis& basis, const Eigen::VectorXd& along,
               double residual_share);
  // Replaces the stored values of a site by those of its explicitly orthogonalised column.
  void correct(Eigen::Index site, const OrthogonalBasis::Outside& part);

  double gain(Eigen::Index site) const {
    const double outside = outside_squared_[site];
    return outside > 0.0 ? correlation_[site] * correlation_[site] / outside : 0.0;
  }
  // Whether `part` of the site's column is large enough for a direction of its own.
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
  // By site; the squares are valid where known_to_ > 0.
  std::vector<Eigen::Index> known_to_;  // number of directions that outside_squared_ accounts for
  Eigen::VectorXd length_squared_;      // |c|^2
  Eigen::VectorXd outside_squared_;     // |c'|^2, 0 for a column in the span of the basis
  Eigen::VectorXd exact_squared_;       // last fully computed |c'|^2
  Eigen::VectorXd correlation_;         // c . r
};

}  // namespace palpate
