// An orthonormal basis of the selected columns, scaled by row_scale, and the residual of the data. Selection methods
// start it with the polynomial tail and add one kernel column at a time.
// Thread guarantee: one object, one thread.
#pragma once

#include <Eigen/Core>

#include "models/correction/sites.h"

namespace palpate {

class OrthogonalBasis {
 public:
  // Starts with the scaled tail columns G of the sites' kernel; the data are row_scale * target. `more`: the maximum
  // number of columns to be added.
  OrthogonalBasis(const Sites& sites, Eigen::Index more);

  // Replaces each column (N rows) by its part orthogonal to the basis, by two passes of Gram-Schmidt (orthogonal to
  // rounding).
  void project_out(Eigen::MatrixXd& columns) const;
  // Adds the direction of a column to the basis and subtracts its component from the residual. A column in the span of
  // the basis (up to a relative 1e-10) is not added; returns whether it was.
  bool add(const Eigen::VectorXd& column);

  // N x (size + 1): the data, then the basis columns.
  Eigen::Ref<const Eigen::MatrixXd> data_and_columns() const { return memory_.leftCols(size_ + 1); }
  // The product of each basis column with the data.
  Eigen::Ref<const Eigen::VectorXd> shares() const { return shares_.head(size_); }
  const Eigen::VectorXd& residual() const { return residual_; }
  Eigen::Index size() const { return size_; }

 private:
  Eigen::MatrixXd memory_;
  Eigen::VectorXd shares_;
  Eigen::VectorXd residual_;
  Eigen::Index size_ = 0;
};

}  // namespace palpate
