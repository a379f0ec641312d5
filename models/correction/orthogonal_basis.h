// An orthonormal basis of the selected columns, scaled by row_scale, with the residual of the data, and the gain of
// each site as the next column. Selection methods start with the polynomial tail and add one kernel column at a time.
// Thread guarantee: one thread per object; `update` starts others itself.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "models/correction/sites.h"
#include "models/model/correction.h"

namespace palpate {

class OrthogonalBasis {
 public:
  // Starts with the scaled tail columns G of the sites' kernel; the data are row_scale * target. `more`: the maximum
  // number of columns to be added.
  OrthogonalBasis(const Sites& sites, Eigen::Index more);

  // Replaces each column (N rows) by its part orthogonal to the basis, by two passes of Gram-Schmidt (orthogonal to
  // rounding).
  void project_out(Eigen::MatrixXd& columns) const;
  // Adds the direction of a column to the basis and subtracts its component from the residual. A column in the span of
  // the basis (up to a relative 1e-10) is not added; returns whether it was.
  bool add(const Eigen::VectorXd& column);

  // N x (size + 1): the data, then the basis columns.
  Eigen::Ref<const Eigen::MatrixXd> data_and_columns() const { return memory_.leftCols(size_ + 1); }
  // The product of each basis column with the data.
  Eigen::Ref<const Eigen::VectorXd> shares() const { return shares_.head(size_); }
  const Eigen::VectorXd& residual() const { return residual_; }
  Eigen::Index size() const { return size_; }

 private:
  Eigen::MatrixXd memory_;
  Eigen::VectorXd shares_;
  Eigen::VectorXd residual_;
  Eigen::Index size_ = 0;
};

// The gain of a site: the decrease (c . r)^2 / |c'|^2 of the squared error, given the basis so far. c is the site's
// scaled kernel column, c' its part orthogonal to the basis, r the residual. The basis only grows, so an update
// subtracts only the components along new directions. |c'|^2 = |c|^2 - |Q^T c|^2 suffers from cancellation when c is
// almost in the span of the basis Q: where its error may exceed 1 %, c' itself is computed, and with |c'| <= 1e-10 |c|
// the gain is 0.
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
