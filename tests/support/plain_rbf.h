// Kernels and RBF functions in a plain loop: the reference for the vectorised form.
#pragma once

#include <algorithm>
#include <cmath>

#include "models/model/correction.h"
#include "models/model/kernels.h"

namespace palpate {

inline double kernel_value(KernelKind kind, double r) {
  switch (kind) {
    case KernelKind::cubic:
      return r * r * r;
    case KernelKind::linear:
      return r;
    case KernelKind::thin_plate:
      return r > 0.0 ? r * r * std::log(r) : 0.0;
  }
  return std::nan("");
}

// h(x) in newtons.
inline double rbf_value(const RbfFunction& function, const double* x) {
  const int dimension = function.dimension();
  double sum = tail_value(function.tail.data(), tail_degree(function.kernel), dimension, x);
  for (Eigen::Index j = 0; j < function.centre_count(); ++j) {
    double squared = 0.0;
    for (int k = 0; k < dimension; ++k) {
      const double difference = x[k] - function.centres(k, j);
      squared += difference * difference;
    }
    sum += function.weights[j] * kernel_value(function.kernel, std::sqrt(squared));
  }
  return sum;
}

namespace test {

// The largest difference of two functions, N, over `points` (d x N, one point a column).
inline double largest_difference(const RbfFunction& a, const RbfFunction& b, const Eigen::MatrixXd& points) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const double* x = points.col(i).data();
    largest = std::max(largest, std::abs(rbf_value(a, x) - rbf_value(b, x)));
  }
  return largest;
}

}  // namespace test
}  // namespace palpate
