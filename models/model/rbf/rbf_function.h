// The data of a fitted radial basis function
//   h(x) = sum_j w_j phi(|x - q_j|) + sum_k d_k g_k(x)
// `RbfEvaluator` (models/model/rbf/rbf_evaluate.h) computes it.
// Source: Hoever & Harders (2009), eq. 2.
#pragma once

#include <Eigen/Core>

#include "models/model/rbf/kernels.h"

namespace palpate {

struct RbfFunction {
  KernelKind kernel = KernelKind::cubic;
  Eigen::MatrixXd centres;  // q, d x n
  Eigen::VectorXd weights;  // w, n
  Eigen::VectorXd tail;     // d_k: tail_size(tail_degree(kernel), d) values, see polynomial_tail.h

  int dimension() const { return static_cast<int>(centres.rows()); }
  Eigen::Index centre_count() const { return centres.cols(); }
};

}  // namespace palpate
