// The BLAS and LAPACK routines of the fits, by their Fortran names, and wrappers for Eigen matrices. These libraries
// select the instruction set at run time; Eigen's own products in a portable build do not. Slow side only.
//
// OpenBLAS treats a processor that is newer than itself as a Prescott of 2004, which makes fits two to three times
// slower (0.3.21 of Debian 12 on a Xeon of 2023). Loading this code selects the right type in OpenBLAS, in programs and
// libraries alike, so that both write the same bytes. If OPENBLAS_CORETYPE is set, that type is used.
#pragma once

#include <Eigen/Core>
#include <mutex>

namespace palpate {

using MatrixRef = Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
using ConstMatrixRef = Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

// Sets the number of threads of BLAS during its lifetime (OpenBLAS only). One suits work that is split by parallel_for
// or too small to split, all suit a large factorisation. The setting is global, so concurrent fits wait for each other;
// one thread may nest these objects.
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

// For programs, at the beginning of main, before another thread computes; not for libraries, whose caller owns these
// settings. Ends the threads that OpenBLAS starts with the program, because they occupy the other cores for some 30 ms.
// From then on products use one thread, except within BlasThreads.
void prepare_blas();

// The number of rows in a block that several products use, so that it stays in the second-level cache.
inline constexpr Eigen::Index kBlockRows = 512;

// c = alpha op(a) op(b) + beta c, where op is the transpose or nothing.
void multiply(const ConstMatrixRef& a, bool transpose_a, const ConstMatrixRef& b, bool transpose_b, double alpha,
              double beta, MatrixRef c);

// The lower triangle of c = a^T a; the rest of c stays as it is.
void gram(const ConstMatrixRef& a, MatrixRef c);

// Replaces the upper triangle of `a` (rows >= cols) by R of its QR factorisation; the rest becomes meaningless.
void qr_in_place(MatrixRef a);

// Eigenvalues in ascending order in `values`, eigenvectors in the columns of `a`, of which only the lower triangle is
// read. False if the iteration did not converge.
bool symmetric_eigen(Eigen::MatrixXd& a, Eigen::VectorXd& values);

// Minimises |a x - b| and returns the x of least norm. Singular values up to `smallest` times the largest count as 0.
// Returns NaN if the iteration did not converge, which fit_centres reports as an error.
Eigen::VectorXd least_squares(Eigen::MatrixXd a, Eigen::VectorXd b, double smallest);

// Cholesky factor in the lower triangle of `a`. False if `a` is not positive definite.
bool cholesky_in_place(MatrixRef a);
// Replaces b by the solution of a x = b; `factor`: from cholesky_in_place.
void cholesky_solve(const ConstMatrixRef& factor, Eigen::VectorXd& b);
// Solves a x = b for a positive semidefinite `a`, given by its lower triangle. Rows and columns are scaled to a
// diagonal of ones, to which `ridge` is added; it is multiplied by 100 until a Cholesky factor exists. Unknowns whose
// diagonal is 0 are 0, and all are 0 if no ridge below 1 suffices.
Eigen::VectorXd solve_with_ridge(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, double ridge);

}  // namespace palpate
