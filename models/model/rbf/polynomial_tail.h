// The polynomial tail of eq. 2 in d variables. Its basis is 1 for degree 0, and 1, x_1 ... x_d for degree 1.
// Source: Hoever & Harders (2009), eq. 2.
// Thread guarantee: pure functions; tail_value is wait-free and allocates nothing.
#pragma once

#include <Eigen/Core>

namespace palpate {

// Number of monomials, L: 1 or 1 + d.
constexpr int tail_size(int degree, int dimension) noexcept { return degree <= 0 ? 1 : 1 + dimension; }

// The tail at a point. `coefficients`: tail_size values, `x`: d values.
inline double tail_value(const double* coefficients, int degree, int dimension, const double* x) noexcept {
  double sum = coefficients[0];
  for (int k = 0; degree > 0 && k < dimension; ++k) sum += coefficients[1 + k] * x[k];
  return sum;
}

// The matrix G of eq. 6: N x L, one row per point. `points`: d x N.
inline Eigen::MatrixXd tail_matrix(int degree, const Eigen::MatrixXd& points) {
  Eigen::MatrixXd matrix(points.cols(), tail_size(degree, static_cast<int>(points.rows())));
  matrix.col(0).setOnes();
  if (degree > 0) matrix.rightCols(points.rows()) = points.transpose();
  return matrix;
}

}  // namespace palpate
