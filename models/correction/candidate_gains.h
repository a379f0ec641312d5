// The gain of each site as the next centre: the decrease (c . r)^2 / |c'|^2 of the squared error, given the basis
// selected so far. c is the site's scaled kernel column, c' its part orthogonal to the basis and r the residual.
//
// c . r and |c'|^2 are stored. The basis only grows, so an update of a site subtracts only the components along the
// directions that were added since its last one.
//
// |c'|^2 = |c|^2 - |Q^T c|^2, with the basis Q, suffers from cancellation when c is almost in the span of the basis.
// Sums of N products are accurate to some 1e-14. Where the error of |c'|^2 may exceed 1 %, c' itself is computed, and a
// site with |c'| <= 1e-10 |c| has gain 0.
// Thread guarantee: one thread per object; `update` starts others itself.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "models/correction/orthogonal_basis.h"
#include "models/model/rbf/rbf_evaluate.h"

namespace palpate {

class CandidateGains {
 public:
  // `sites` must outlive this.
  explicit CandidateGains(const Sites& sites);

  // The scaled kernel columns of centres at some sites, N x count.
  Eigen::MatrixXd columns(std::span<const Eigen::Index> sites) const;

  // Updates these distinct sites to the current basis, which must be that of the last call or grown from it. O(N x new
  // directions) for each site. The result does not depend on the number of cores.
  void update(std::span<const Eigen::Index> sites, const OrthogonalBasis& basis);

  double gain(Eigen::Index site) const {
    const SiteGain& one = candidates_[static_cast<std::size_t>(site)];
    return one.outside > 0.0 ? one.correlation * one.correlation / one.outside : 0.0;
  }

 private:
  struct SiteGain {
    Eigen::Index known = 0;    // directions of the basis (columns of data_and_columns()) that the rest contains
    double length = 0.0;       // |c|^2
    double outside = 0.0;      // |c'|^2 by subtraction; 0 for a column in the span of the basis
    double exact = 0.0;        // |c'|^2 when c' was last computed itself; tells when cancellation sets in
    double correlation = 0.0;  // c . r
  };
  SiteGain& candidate(Eigen::Index site) { return candidates_[static_cast<std::size_t>(site)]; }
  Eigen::Index least_known(std::span<const Eigen::Index> sites) const;
  // `directions`: the last columns of data_and_columns(), scaled: those that one of the sites lacks.
  void update_group(std::span<const Eigen::Index> sites, const Eigen::MatrixXd& directions,
                    const OrthogonalBasis& basis);
  void recompute_cancelled(std::span<const Eigen::Index> sites, const OrthogonalBasis& basis);

  const Sites& sites_;
  PointArrays points_;
  std::vector<SiteGain> candidates_;  // one for each site
};

}  // namespace palpate
