// The polynomial tail of eq. 2: a basis g_k of the polynomials of degree <= m
// (0, 1 or 2) in d variables, in the order
//   1, x_1 ... x_d, x_1 x_1, x_1 x_2 ... x_1 x_d, x_2 x_2 ... x_d x_d.
// Thread guarantee: pure functions; tail_value is wait-free, allocates nothing.
// Source: Hoever & Harders (2009), eq. 2.
#pragma once

#include <Eigen/Core>

namespace palpate {

// Number of monomials, L: 1, 1 + d or (d + 1)(d + 2) / 2.
constexpr int tail_size(int degree, int dimension) noexcept {
  if (degree <= 0) return 1;
  return degree == 1 ? 1 + dimension : (dimension + 1) * (dimension + 2) / 2;
}

// sum_k coefficients[k] g_k(x). `coefficients`: tail_size values, `x`: d values.
inline double tail_value(const double* coefficients, int degree, int dimension, const double* x) noexcept {
  double sum = coefficients[0];
  if (degree <= 0) return sum;
  const double* linear = coefficients + 1;
  for (int k = 0; k < dimension; ++k) sum += linear[k] * x[k];
  if (degree == 1) return sum;
  const double* quadratic = linear + dimension;
  for (int i = 0; i < dimension; ++i) {
    double row = 0.0;
    for (int j = i; j < dimension; ++j) row += *quadratic++ * x[j];
    sum += row * x[i];
  }
  return sum;
}

// The matrix G of eq. 6: N x L, one row per point. `points`: d x N.
inline Eigen::MatrixXd tail_matrix(int degree, const Eigen::MatrixXd& points) {
  const int dimension = static_cast<int>(points.rows());
  Eigen::MatrixXd matrix(points.cols(), tail_size(degree, dimension));
  matrix.col(0).setOnes();
  if (degree >= 1) matrix.middleCols(1, dimension) = points.transpose();
  if (degree >= 2) {
    Eigen::Index column = 1 + dimension;
    for (int i = 0; i < dimension; ++i)
      for (int j = i; j < dimension; ++j) matrix.col(column++) = points.row(i).cwiseProduct(points.row(j)).transpose();
  }
  return matrix;
}

}  // namespace palpate
