// The linear algebra of the methods: weights for given centres, and the gains of candidates for centres.
// Thread guarantee: slow side. The sites must pass validate_sites.
#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "models/correction/methods.h"
#include "models/linear/lapack.h"
#include "models/model/correction.h"

namespace palpate {

// The kernel matrix between points, with the polynomial tail projected out.
//
// With S = diag(scale), K = sign S Phi S, q an orthonormal basis of the columns of S G and P = I - q q^T: if u = P u,
// the weights w = sign S u satisfy the side condition G^T w = 0, and their roughness w^T (sign Phi) w is u^T P K P u >=
// 0. With all sites as centres the smoothing spline solves (P K P + smoothing I) u = P S f; with some the matrix of the
// centres, with S = I, is the penalty.
// Source: Hoever & Harders (2009), eqs. 2-8; Wahba (1990) for the form.
class ProjectedKernel {
 public:
  // `points`: d x N, N >= 1; `scale`: N factors >= 0.
  ProjectedKernel(KernelKind kernel, const Eigen::MatrixXd& points, const Eigen::VectorXd& scale);

  // The lower triangle of P K P + fill q q^T + smoothing I, N x N; the upper one is not set. Uses all cores.
  Eigen::MatrixXd matrix(double fill, double smoothing) const;
  // The Cholesky factor of that matrix with the mean eigenvalue as fill. If rounding prevents it, the smoothing is
  // multiplied by ten until the factor exists; none after eight attempts, or if interrupted.
  std::optional<Eigen::MatrixXd> cholesky(double smoothing, const FitControl& control = {}) const;
  // u = P u that solves (P K P + smoothing I) u = P data; none as for cholesky().
  //
  // Above kFactorisedSites by conjugate gradients, whose preconditioner is (L L^T + smoothing I)^-1 with a partial
  // Cholesky factor L of P K P: where the smoothing is above most eigenvalues, an eighth of the columns leaves a
  // remainder that needs 10 to 50 steps of N^2 kernels. Otherwise by the whole factor, in N^3 / 3 operations. Source:
  // Harbrecht, Peters & Schneider (2012), section 2, for L.
  struct Solution {
    Eigen::VectorXd u;
    double condition_number = 0.0;  // estimated by the power method
  };
  std::optional<Solution> solve(const Eigen::VectorXd& data, double smoothing, const FitControl& control) const;

  // P v.
  Eigen::VectorXd project(const Eigen::VectorXd& v) const { return v - q_ * (q_.transpose() * v); }
  // Replaces a matrix with N columns by its product with P.
  void project_rows(MatrixRef matrix) const;
  // K v.
  Eigen::VectorXd multiply_kernel(const Eigen::VectorXd& v) const;
  // The least squares solution d of S G d = v.
  Eigen::VectorXd tail_of(const Eigen::VectorXd& v) const { return tail_.solve(v).cwiseQuotient(tail_scale_); }

  // Mean eigenvalue of P K P; at least 1 if that is zero to rounding (all points are the same).
  double mean_eigenvalue() const { return mean_eigenvalue_; }
  // The smallest smoothing above the rounding errors of the matrix.
  double smallest_smoothing() const { return smallest_smoothing_; }

 private:
  static constexpr Eigen::Index kBlock = 64;  // columns at a time; a multiple of 8
  // The factor of so many takes a third of a second of one core.
  static constexpr Eigen::Index kFactorisedSites = 4096;

  // P K P + fill q q^T, in the rows from `first` on (a multiple of 8) and the columns of these sites. `update`: half
  // of what is subtracted for fill, N x rank.
  void entries(const std::vector<Eigen::Index>& sites, Eigen::Index first, const Eigen::MatrixXd& update,
               MatrixRef out) const;
  // L, with an eighth of the columns or fewer; no columns where the rest of P K P is too large.
  Eigen::MatrixXd low_rank(double smoothing) const;
  // None if L does not suffice, or if interrupted.
  std::optional<Solution> iterate(const Eigen::VectorXd& data, double smoothing, const FitControl& control) const;

  KernelKind kernel_;
  Eigen::MatrixXd points_;
  PointArrays arrays_;  // the same points
  Eigen::VectorXd scale_;
  Eigen::VectorXd tail_scale_;                                    // the length of each column of S G
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> tail_;  // of S G with columns of length 1
  Eigen::MatrixXd q_;                                             // N x rank
  Eigen::MatrixXd half_update_;                                   // V of P K P = K - q V^T - V q^T
  double mean_eigenvalue_ = 1.0, smallest_smoothing_ = 0.0;
};

// Weights and tail for given centres, by penalised least squares:
//   minimise sum_i row_scale_i^2 (f_i - h(x_i))^2 + smoothing w^T (sign Phi) w
//   subject to G^T w = 0,
// Phi and G are the kernel and the tail at the centres. If every site is a centre, this is the smoothing spline;
// otherwise it is the regression spline on a subset of its basis, which approaches it with more centres.
//
// With Sites::truncation the weights are those of the paper: eq. 8 and the rows of the side condition (eq. 3), by a
// pseudo-inverse without the singular values below this share of the largest.
//
// A QR factorisation reduces the N rows block by block to a small triangle, to which the penalty is added. It has the
// accuracy of a QR factorisation of the whole matrix, with memory O(columns^2 + block) for any N.
// Sources: Hoever & Harders (2009), eq. 8 and section 4.2.1; Wahba (1990), sections 1.3 and 7.2; Golub & Van Loan,
// Matrix Computations, 5.5.8.
//
// R of a QR factorisation of row_scale (G Phi f), with the tail, the kernel at the n centres and the data, for the
// sites in `rows` (first and count): (tail + n + 1) squared. The least squares problem of the sites is that of R.
Eigen::MatrixXd reduced_rows(const Sites& sites, const Eigen::MatrixXd& centres, Eigen::Index first,
                             Eigen::Index count);
// R of the rows of two such triangles.
Eigen::MatrixXd joined_triangles(const Eigen::MatrixXd& above, const Eigen::MatrixXd& below);

// `centres`: d x n, any points, n may be 0. Deterministic; uses two threads.
FittedCorrection solve_weights(const Sites& sites, const Eigen::MatrixXd& centres);

// The limit of the number of sites; more would take over 4 GiB and minutes.
inline constexpr Eigen::Index kMostDirectSites = 20000;

// With every site as a centre: the solution of the projected system, whose time and memory are those of
// ProjectedKernel::solve. The paper inverts the saddle matrix of eq. 4 by truncated singular values, which takes a
// hundred times as long and has the same purpose (models/fit/fit.h). With smoothing 0 the function interpolates as
// closely as the smallest smoothing allows at which the matrix can be factorised. Errors: too many sites; no
// factorisation; interrupted, checked before each step. Deterministic on one machine. Source: Hoever & Harders (2009),
// eqs. 2-8.
Result<FittedCorrection> solve_direct(const Sites& sites, const FitControl& control = {});

// An orthonormal basis of the selected columns, scaled by row_scale, with the residual of the data, and the gain of
// each site as the next column. Selection methods start with the polynomial tail and add one kernel column at a time.
// One thread per object; `update` starts others itself.
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
