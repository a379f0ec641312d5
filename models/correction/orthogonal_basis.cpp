#include "models/correction/orthogonal_basis.h"

#include "models/linear/lapack.h"
#include "models/model/rbf/polynomial_tail.h"

namespace palpate {

OrthogonalBasis::OrthogonalBasis(const Sites& sites, Eigen::Index more) {
  const Eigen::MatrixXd tail = sites.row_scale.asDiagonal() * tail_matrix(tail_degree(sites.kernel), sites.points);
  memory_.resize(sites.count(), tail.cols() + more + 1);
  shares_.resize(tail.cols() + more);
  residual_ = memory_.col(0) = sites.target_N.cwiseProduct(sites.row_scale);
  for (Eigen::Index k = 0; k < tail.cols(); ++k) add(tail.col(k));
}

void OrthogonalBasis::project_out(Eigen::MatrixXd& columns) const {
  const auto basis = memory_.middleCols(1, size_);
  Eigen::MatrixXd shares(size_, columns.cols());
  for (int pass = 0; pass < 2; ++pass) {
    multiply(basis, true, columns, false, 1.0, 0.0, shares);
    multiply(basis, false, shares, false, -1.0, 1.0, columns);
  }
}

bool OrthogonalBasis::add(const Eigen::VectorXd& column) {
  // Such a column, for example of a constant feature, is rounding only.
  constexpr double kDependent = 1e-10;
  Eigen::MatrixXd part = column;
  project_out(part);
  const double length = part.norm();
  if (!(length > kDependent * column.norm())) return false;
  const Eigen::VectorXd q = part / length;
  shares_(size_) = q.dot(residual_);
  residual_ -= shares_(size_) * q;
  memory_.col(++size_) = q;
  return true;
}

}  // namespace palpate
