// An orthonormal basis of the columns chosen so far, of the rows scaled by
// row_scale, and what of the data lies outside it. Selection methods start it
// with the polynomial tail and add one kernel column at a time.
// Thread guarantee: one object, one thread.
#pragma once

#include <Eigen/Core>

#include "models/model/rbf/kernels.h"
#include "models/training/sites.h"

namespace palpate {

class OrthogonalBasis {
 public:
  // The scaled tail columns G of the kernel, and row_scale * target as data.
  // Room for `more` further columns.
  OrthogonalBasis(const Sites& sites, KernelKind kernel, Eigen::Index more);

  // A column's part outside the basis, by two passes of Gram-Schmidt, which
  // leave it orthogonal to rounding.
  struct Outside {
    Eigen::VectorXd column;
    double squared = 0.0;      // its squared length
    double correlation = 0.0;  // its product with the residual
  };
  Outside outside(const Eigen::VectorXd& column) const;
  // Leaves of each column (N rows) its part outside, by the same two passes.
  void project_out(Eigen::MatrixXd& columns) const;

  // Makes the direction part of the basis and takes its share from the
  // residual. Returns q, the new unit column. `part.squared` > 0.
  Eigen::VectorXd add(const Outside& part);

  // N x (size + 1): the basis columns, then the residual.
  Eigen::Ref<const Eigen::MatrixXd> columns_and_residual() const { return memory_.leftCols(size_ + 1); }
  Eigen::Ref<const Eigen::MatrixXd> columns() const { return memory_.leftCols(size_); }
  Eigen::Ref<const Eigen::VectorXd> residual() const { return memory_.col(size_); }
  Eigen::Index size() const { return size_; }

 private:
  Eigen::MatrixXd memory_;
  Eigen::Index size_ = 0;
};

}  // namespace palpate
