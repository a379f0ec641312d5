#include "models/solve/orthogonal_basis.h"

#include <cmath>

#include "models/linear/lapack.h"
#include "models/model/rbf/polynomial_tail.h"

namespace palpate {
namespace {

// Tail columns nearer than this to the span of the others (a constant feature) are rounding only.
constexpr double kDependent = 1e-10;

}  // namespace

OrthogonalBasis::OrthogonalBasis(const Sites& sites, KernelKind kernel, Eigen::Index more) {
  Eigen::MatrixXd tail = tail_matrix(tail_degree(kernel), sites.points);
  tail.array().colwise() *= sites.row_scale.array();
  memory_.resize(sites.count(), tail.cols() + more + 1);
  memory_.col(0) = sites.target_N.cwiseProduct(sites.row_scale);
  for (Eigen::Index k = 0; k < tail.cols(); ++k) {
    const Outside part = outside(tail.col(k));
    if (part.squared > kDependent * kDependent * tail.col(k).squaredNorm()) add(part);
  }
}

OrthogonalBasis::Outside OrthogonalBasis::outside(const Eigen::VectorXd& column) const {
  Eigen::MatrixXd rest = column;
  project_out(rest);
  return {rest.col(0), rest.squaredNorm(), rest.col(0).dot(residual())};
}

void OrthogonalBasis::project_out(Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd shares(size_, columns.cols());
  for (int pass = 0; pass < 2; ++pass) {
    multiply(memory_.leftCols(size_), true, columns, false, 1.0, 0.0, shares);
    multiply(memory_.leftCols(size_), false, shares, false, -1.0, 1.0, columns);
  }
}

Eigen::VectorXd OrthogonalBasis::add(const Outside& part) {
  const Eigen::VectorXd q = part.column / std::sqrt(part.squared);
  const Eigen::VectorXd left = residual() - q.dot(residual()) * q;
  memory_.col(size_) = q;
  ++size_;
  memory_.col(size_) = left;
  return q;
}

}  // namespace palpate
