// The few BLAS and LAPACK routines the fits use, by their Fortran names, and
// thin wrappers for Eigen matrices. They choose the best instructions when the
// program runs, which Eigen's own products in a portable build do not.
// Off the tick only.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <mutex>

namespace palpate {

using MatrixRef = Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
using ConstMatrixRef = Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

// Sets the threads of BLAS (OpenBLAS; others are left alone) while it lives:
// one thread where work is split by parallel_for or is too small to split,
// all of them for a large factorisation. The setting is global, so fits that
// run at once take turns; the same thread may nest them.
class BlasThreads {
 public:
  explicit BlasThreads(int count);
  ~BlasThreads();
  BlasThreads(const BlasThreads&) = delete;
  BlasThreads& operator=(const BlasThreads&) = delete;

 private:
  std::unique_lock<std::recursive_mutex> lock_;
  int before_ = 0;
};

// For programs, at the beginning of main, before another thread computes; not in a library,
// whose user owns these settings. OpenBLAS takes a processor that is newer than itself for a
// Prescott of 2004, which makes fits two to three times slower (0.3.21 of Debian 12 on a Xeon
// of 2023): then it chooses again, unless OPENBLAS_CORETYPE says which. And the threads that it
// has started with the program end, which spin on the other cores for some 30 ms whether
// anything is computed or not; from then on products are on one thread, but within BlasThreads.
void prepare_blas();

// c = alpha op(a) op(b) + beta c, op being the transpose where asked.
void multiply(const ConstMatrixRef& a, bool transpose_a, const ConstMatrixRef& b, bool transpose_b, double alpha,
              double beta, MatrixRef c);

// The lower triangle of c = a^T a; what is above stays.
void gram(const ConstMatrixRef& a, MatrixRef c);

// Replaces the upper triangle of `a` (rows >= cols) by R of its QR
// factorisation; below the diagonal it holds reflectors afterwards, whose factors are
// the result.
Eigen::MatrixXd qr_in_place(MatrixRef a);
// c = Q^T c, of `a` and `factors` as qr_in_place leaves them.
void apply_transposed_q(const ConstMatrixRef& a, const Eigen::MatrixXd& factors, Eigen::VectorXd& c);

// Eigenvalues ascending in `values`, eigenvectors in the columns of `a` (only
// the lower triangle is read). False when the iteration did not converge.
bool symmetric_eigen(Eigen::MatrixXd& a, Eigen::VectorXd& values);

// Singular values of `a` (rows >= columns) descending in `values`; `a` becomes U, its columns, and V^T is in
// `v_transposed`. False when the iteration did not converge.
bool singular_values(Eigen::MatrixXd& a, Eigen::VectorXd& values, Eigen::MatrixXd& v_transposed);

// Cholesky factor in the lower triangle of `a`. False when `a` is not positive
// definite, or when `may_continue`, asked now and then with the share done, says no.
bool cholesky_in_place(MatrixRef a, const std::function<bool(double)>& may_continue = {});
// Solves a x = b in place, `factor` from cholesky_in_place.
void cholesky_solve(const ConstMatrixRef& factor, Eigen::VectorXd& b);
// Estimate of the condition number in the 1-norm. `norm`: norm_1 of the matrix.
double cholesky_condition(const ConstMatrixRef& factor, double norm);
// The 1-norm of a symmetric matrix given by its lower triangle.
double symmetric_norm(const ConstMatrixRef& a);

}  // namespace palpate
