#include "models/linear/lapack.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string_view>
#include <vector>

extern "C" {
void dgemm_(const char*, const char*, const int*, const int*, const int*, const double*, const double*, const int*,
            const double*, const int*, const double*, double*, const int*);
void dgemv_(const char*, const int*, const int*, const double*, const double*, const int*, const double*, const int*,
            const double*, double*, const int*);
void dgeqrt_(const int*, const int*, const int*, double*, const int*, double*, const int*, double*, int*);
void dsyrk_(const char*, const char*, const int*, const int*, const double*, const double*, const int*, const double*,
            double*, const int*);
void dgesdd_(const char*, const int*, const int*, double*, const int*, double*, double*, const int*, double*,
             const int*, double*, const int*, int*, int*);
void dpotrf_(const char*, const int*, double*, const int*, int*);
void dtrsm_(const char*, const char*, const char*, const char*, const int*, const int*, const double*, const double*,
            const int*, double*, const int*);
void dpstrf_(const char*, const int*, double*, const int*, int*, int*, const double*, double*, int*);
// Only in OpenBLAS; null with another BLAS.
[[gnu::weak]] void openblas_set_num_threads(int);
[[gnu::weak]] int openblas_get_num_threads(void);
[[gnu::weak]] int blas_thread_shutdown_(void);
[[gnu::weak]] char* openblas_get_corename(void);
[[gnu::weak]] void gotoblas_dynamic_quit(void);
[[gnu::weak]] void gotoblas_dynamic_init(void);
}

namespace palpate {
namespace {

std::recursive_mutex& blas_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

// Restarts OpenBLAS with its variable for the core type set, if it did not recognise a newer core. Runs when the
// program or library is loaded, because another thread may compute later.
[[gnu::constructor]] void choose_blas_core() {
#ifdef __x86_64__
  constexpr const char* kVariable = "OPENBLAS_CORETYPE";
  if (openblas_get_corename == nullptr || gotoblas_dynamic_quit == nullptr || gotoblas_dynamic_init == nullptr) return;
  if (std::getenv(kVariable) != nullptr || std::string_view(openblas_get_corename()) != "Prescott") return;
  __builtin_cpu_init();
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return;
  const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
                    __builtin_cpu_supports("avx512cd");
  setenv(kVariable, wide ? "SkylakeX" : "Haswell", 0);
  gotoblas_dynamic_quit();
  gotoblas_dynamic_init();
  unsetenv(kVariable);
#endif
}

int to_int(Eigen::Index value) { return static_cast<int>(value); }

int leading(const auto& a) { return std::max(1, to_int(a.outerStride())); }

void rank_update(const char* transpose, Eigen::Index size, Eigen::Index depth, const ConstMatrixRef& a, MatrixRef c) {
  assert(c.rows() == size && c.cols() == size);
  if (size == 0) return;
  const int n = to_int(size), k = to_int(depth);
  const double one = 1.0, zero = 0.0;
  const int lda = leading(a), ldc = leading(c);
  dsyrk_("L", transpose, &n, &k, &one, a.data(), &lda, &zero, c.data(), &ldc);
}

// 1 / sqrt(d_i), and 0 where d_i is not above 0: scales a matrix with this diagonal to a diagonal of ones.
Eigen::VectorXd inverse_roots(Eigen::VectorXd diagonal) {
  for (double& value : diagonal) value = value > 0.0 ? 1.0 / std::sqrt(value) : 0.0;
  return diagonal;
}

}  // namespace

BlasThreads::BlasThreads(int count) : lock_(blas_mutex()) {
  if (openblas_set_num_threads == nullptr || openblas_get_num_threads == nullptr) return;
  before_ = openblas_get_num_threads();
  if (before_ != count) openblas_set_num_threads(count);
}

BlasThreads::~BlasThreads() {
  if (before_ > 0 && openblas_get_num_threads() != before_) openblas_set_num_threads(before_);
}

void prepare_blas() {
  if (openblas_set_num_threads == nullptr || blas_thread_shutdown_ == nullptr) return;
  openblas_set_num_threads(1);
  blas_thread_shutdown_();  // starts them again when more are asked for
}

std::string blas_name() {
  return openblas_get_corename == nullptr ? "BLAS" : std::string("OpenBLAS ") + openblas_get_corename();
}

void multiply(const ConstMatrixRef& a, bool transpose_a, const ConstMatrixRef& b, bool transpose_b, double alpha,
              double beta, MatrixRef c) {
  const int m = to_int(c.rows()), n = to_int(c.cols());
  const int k = to_int(transpose_a ? a.rows() : a.cols());
  assert(m == (transpose_a ? a.cols() : a.rows()) && n == (transpose_b ? b.rows() : b.cols()));
  assert(k == (transpose_b ? b.cols() : b.rows()));
  if (m == 0 || n == 0) return;
  const int lda = leading(a), ldb = leading(b), ldc = leading(c);
  if (n <= 2 && !transpose_b) {
    // dgemm would copy all of `a`, which takes longer than the product.
    const int rows = to_int(a.rows()), columns = to_int(a.cols()), one = 1;
    for (int j = 0; j < n; ++j) {
      dgemv_(transpose_a ? "T" : "N", &rows, &columns, &alpha, a.data(), &lda, b.col(j).data(), &one, &beta,
             c.col(j).data(), &one);
    }
    return;
  }
  dgemm_(transpose_a ? "T" : "N", transpose_b ? "T" : "N", &m, &n, &k, &alpha, a.data(), &lda, b.data(), &ldb, &beta,
         c.data(), &ldc);
}

void gram(const ConstMatrixRef& a, MatrixRef c) { rank_update("T", a.cols(), a.rows(), a, c); }

void gram_of_transpose(const ConstMatrixRef& at, MatrixRef c) { rank_update("N", at.rows(), at.cols(), at, c); }

// Uses the recursive panels of dgeqrt: dgeqrf factorises up to 128 columns one by one, which takes 2.5 times as long
// with 106 columns.
void qr_in_place(MatrixRef a) {
  assert(a.rows() >= a.cols());
  const int m = to_int(a.rows()), n = to_int(a.cols());
  if (n == 0) return;
  const int lda = leading(a), block = std::min(32, n);
  Eigen::MatrixXd factors(block, n);
  Eigen::VectorXd work(block * n);
  int info = 0;
  dgeqrt_(&m, &n, &block, a.data(), &lda, factors.data(), &block, work.data(), &info);
  assert(info == 0);
}

SingularValues singular_values(Eigen::MatrixXd a) {
  const int m = to_int(a.rows()), n = to_int(a.cols()), least = std::min(m, n);
  SingularValues found{Eigen::MatrixXd(m, least), Eigen::VectorXd(least), Eigen::MatrixXd(least, n)};
  if (least == 0) return found;
  double wanted = 0.0;
  int query = -1, info = 0;
  std::vector<int> integers(8 * static_cast<std::size_t>(least));
  dgesdd_("S", &m, &n, a.data(), &m, found.values.data(), found.u.data(), &m, found.vt.data(), &least, &wanted, &query,
          integers.data(), &info);
  const int work_size = static_cast<int>(wanted);
  Eigen::VectorXd work(work_size);
  dgesdd_("S", &m, &n, a.data(), &m, found.values.data(), found.u.data(), &m, found.vt.data(), &least, work.data(),
          &work_size, integers.data(), &info);
  if (info != 0) found.values.setConstant(std::numeric_limits<double>::quiet_NaN());
  return found;
}

Eigen::Index SingularValues::rank(double smallest) const {
  Eigen::Index count = 0;
  while (count < values.size() && values(count) > smallest * values(0)) ++count;
  return count;
}

double SingularValues::condition_number(double smallest) const {
  const Eigen::Index kept = rank(smallest);
  return kept > 0 ? values(0) / values(kept - 1) : 1.0;
}

Eigen::VectorXd SingularValues::solve(const Eigen::VectorXd& b, double smallest) const {
  if (!values.allFinite()) return Eigen::VectorXd::Constant(vt.cols(), std::numeric_limits<double>::quiet_NaN());
  const Eigen::Index kept = rank(smallest);
  const Eigen::VectorXd shares = (u.leftCols(kept).transpose() * b).cwiseQuotient(values.head(kept));
  return vt.topRows(kept).transpose() * shares;
}

bool cholesky_in_place(MatrixRef a) {
  const int n = to_int(a.rows()), lda = leading(a);
  int info = 0;
  dpotrf_("L", &n, a.data(), &lda, &info);
  return info == 0;
}

bool cholesky_in_place(MatrixRef a, const FitControl& control) {
  const double one = 1.0, minus_one = -1.0;
  const int lda = leading(a);
  const Eigen::Index size = a.rows();
  for (Eigen::Index first = 0, columns = 0; first < size; first += columns) {
    const double left = static_cast<double>(size - first) / static_cast<double>(size);
    if (!control.may_continue(1.0 - left * left * left)) return false;
    columns = std::min<Eigen::Index>(256, size - first);
    const Eigen::Index below = size - first - columns;
    if (!cholesky_in_place(a.block(first, first, columns, columns))) return false;
    if (below == 0) break;
    const int m = to_int(below), n = to_int(columns);
    double* const panel = &a(first + columns, first);
    solve_triangle(a.block(first, first, columns, columns), a.block(first + columns, first, below, columns));
    dsyrk_("L", "N", &m, &n, &minus_one, panel, &lda, &one, &a(first + columns, first + columns), &lda);
  }
  return true;
}

void solve_triangle(const ConstMatrixRef& lower, MatrixRef rows) {
  const double one = 1.0;
  const int m = to_int(rows.rows()), n = to_int(rows.cols()), lda = leading(lower), ldb = leading(rows);
  dtrsm_("R", "L", "T", "N", &m, &n, &one, lower.data(), &lda, rows.data(), &ldb);
}

std::vector<int> cholesky_pivots(MatrixRef a, double least) {
  const int n = to_int(a.rows()), lda = leading(a);
  int rank = 0, info = 0;
  std::vector<int> pivots(static_cast<std::size_t>(n));
  Eigen::VectorXd work(2 * n);
  dpstrf_("L", &n, a.data(), &lda, pivots.data(), &rank, &least, work.data(), &info);
  pivots.resize(static_cast<std::size_t>(rank));
  for (int& pivot : pivots) --pivot;
  return pivots;
}

void cholesky_solve(const ConstMatrixRef& factor, Eigen::VectorXd& b) {
  factor.triangularView<Eigen::Lower>().solveInPlace(b);
  factor.triangularView<Eigen::Lower>().transpose().solveInPlace(b);
}

Eigen::VectorXd solve_with_ridge(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, double ridge) {
  const Eigen::VectorXd scale = inverse_roots(a.diagonal());
  const Eigen::MatrixXd scaled = scale.asDiagonal() * a * scale.asDiagonal();
  for (; ridge < 1.0; ridge *= 100.0) {
    Eigen::MatrixXd factor = scaled;
    factor.diagonal().array() += ridge;
    if (!cholesky_in_place(factor)) continue;
    Eigen::VectorXd x = b.cwiseProduct(scale);
    cholesky_solve(factor, x);
    return x.cwiseProduct(scale);
  }
  return Eigen::VectorXd::Zero(b.size());
}

Eigen::VectorXd solve_non_negative(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right_side,
                                   const Eigen::VectorXd& start) {
  const Eigen::VectorXd inverse_norm = inverse_roots(gram.diagonal());
  Eigen::MatrixXd scaled = inverse_norm.asDiagonal() * gram * inverse_norm.asDiagonal();
  // Far below the information in a recording and far above rounding: decides only between equal columns.
  scaled.diagonal().array() += 1e-8;
  const Eigen::VectorXd right = right_side.cwiseProduct(inverse_norm);
  const Eigen::Index size = right.size();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size);
  Eigen::Array<bool, Eigen::Dynamic, 1> passive = Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(size, false);
  const auto unconstrained = [&] {
    std::vector<Eigen::Index> index;
    for (Eigen::Index i = 0; i < size; ++i)
      if (passive(i)) index.push_back(i);
    Eigen::VectorXd full = Eigen::VectorXd::Zero(size);
    // By Eigen: LAPACK's would depend on the number of threads of the program that calls the library.
    const Eigen::MatrixXd part = scaled(index, index);
    const Eigen::VectorXd part_right = right(index);
    if (!index.empty()) full(index) = part.llt().solve(part_right).eval();
    return full;
  };
  // Moves x towards the minimum over the passive set. A coefficient that would become negative stops the step and
  // leaves the set.
  const auto move_to_minimum = [&] {
    Eigen::VectorXd candidate = unconstrained();
    for (Eigen::Index leaving = 0; leaving < size; ++leaving) {
      const auto negative = passive && !(candidate.array() > 0.0);
      if (!negative.any()) break;
      const Eigen::ArrayXd reach = negative.select(x.array() / (x - candidate).array().max(1e-300), 2.0);
      Eigen::Index blocking = 0;
      x += reach.minCoeff(&blocking) * (candidate - x);
      x(blocking) = 0.0;
      passive(blocking) = false;
      candidate = unconstrained();
    }
    x = candidate;
  };
  if (start.size() > 0 && (start.array() > 0.0).any()) {
    const auto moving = inverse_norm.array() > 0.0;
    x = moving.select(start.array() / moving.select(inverse_norm.array(), 1.0), 0.0).matrix();
    passive = x.array() > 0.0;
    move_to_minimum();
  }
  // The method ends after a few changes; 3 n is the limit of its authors.
  for (Eigen::Index change = 0; change < 3 * size; ++change) {
    const Eigen::VectorXd gradient = right - scaled * x;
    const double tolerance = 1e-12 * std::max(1e-300, right.cwiseAbs().maxCoeff());
    Eigen::Index entering = 0;
    if (!(passive.select(0.0, gradient.array()).maxCoeff(&entering) > tolerance)) break;
    passive(entering) = true;
    move_to_minimum();
  }
  return x.cwiseMax(0.0).cwiseProduct(inverse_norm);
}

}  // namespace palpate
