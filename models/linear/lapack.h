// The BLAS and LAPACK routines of the fits, which select the instruction set at run time, for Eigen matrices, and
// non-negative least squares. Slow side only.
//
// OpenBLAS treats a processor that is newer than itself as a Prescott of 2004, which makes fits two to three times
// slower (0.3.21 of Debian 12 on a Xeon of 2023). Loading this code selects the right type in OpenBLAS, in programs and
// libraries alike, so that both write the same bytes. If OPENBLAS_CORETYPE is set, that type is used.
#pragma once

#include <Eigen/Core>
#include <mutex>
#include <string>
#include <vector>

#include "engine/base/parallel.h"

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
// "OpenBLAS SkylakeX", with the processor type that it selected; "BLAS" where it does not say.
std::string blas_name();

// The number of rows in a block that several products use, so that it stays in the second-level cache.
inline constexpr Eigen::Index kBlockRows = 512;

// c = alpha op(a) op(b) + beta c, where op is the transpose or nothing.
void multiply(const ConstMatrixRef& a, bool transpose_a, const ConstMatrixRef& b, bool transpose_b, double alpha,
              double beta, MatrixRef c);
// The lower triangle of c = a^T a; the rest of c stays as it is. `at`: a is given by its transpose, whose columns are
// the rows of a.
void gram(const ConstMatrixRef& a, MatrixRef c);
void gram_of_transpose(const ConstMatrixRef& at, MatrixRef c);
// Replaces the upper triangle of `a` (rows >= cols) by R of its QR factorisation; the rest becomes meaningless.
void qr_in_place(MatrixRef a);

// The singular value decomposition a = u diag(values) v^T, with min(rows, columns) values in descending order. All are
// NaN if the iteration did not converge, which fit_centres reports as an error.
struct SingularValues {
  Eigen::MatrixXd u;
  Eigen::VectorXd values;
  Eigen::MatrixXd vt;

  // The number of values above `smallest` times the largest, and the ratio of the largest of them to the last.
  Eigen::Index rank(double smallest) const;
  double condition_number(double smallest) const;
  // The x of least norm that minimises |a x - b|. Values up to `smallest` times the largest count as 0.
  Eigen::VectorXd solve(const Eigen::VectorXd& b, double smallest) const;
};
SingularValues singular_values(Eigen::MatrixXd a);
// Cholesky factor in the lower triangle of `a`. False if `a` is not positive definite.
bool cholesky_in_place(MatrixRef a);
// The same in steps of some hundred columns. False, too, if `control` interrupts it; the fraction is that of the
// operations.
bool cholesky_in_place(MatrixRef a, const FitControl& control);
// Replaces `rows` by rows L^-T; `lower`: L, a Cholesky factor.
void solve_triangle(const ConstMatrixRef& lower, MatrixRef rows);
// The pivots of a Cholesky factorisation of a positive semidefinite `a` that takes the largest rest of the diagonal
// first, as long as it is above `least`. Sets the lower triangle of their rows, in this order, to their factor.
std::vector<int> cholesky_pivots(MatrixRef a, double least);
// Replaces b by the solution of a x = b; `factor`: from cholesky_in_place.
void cholesky_solve(const ConstMatrixRef& factor, Eigen::VectorXd& b);
// Solves a x = b for a positive semidefinite `a`, given by its lower triangle. Rows and columns are scaled to a
// diagonal of ones, to which `ridge` is added; it is multiplied by 100 until a Cholesky factor exists. Unknowns whose
// diagonal is 0 are 0, and all are 0 if no ridge below 1 suffices.
Eigen::VectorXd solve_with_ridge(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, double ridge);
// Minimises x^T G x - 2 b^T x subject to x >= 0. `gram`: G, n x n, symmetric, positive semidefinite; a ridge of 1e-8
// separates equal columns. `start`: initial x, n values >= 0, or empty. Returns n values.
Eigen::VectorXd solve_non_negative(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right_side,
                                   const Eigen::VectorXd& start = {});

}  // namespace palpate
