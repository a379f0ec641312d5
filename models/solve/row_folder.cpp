#include "models/solve/row_folder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/parallel.h"
#include "models/model/rbf/polynomial_tail.h"

namespace palpate {

RowFolder::RowFolder(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres)
    : sites_(sites),
      kernel_(kernel),
      centres_(centres),
      points_(sites.points),
      columns_(centres.cols() + tail_size(tail_degree(kernel), sites.dimension())),
      block_rows_(std::max<Eigen::Index>(1024, (2 * columns_ + 9) / 8 * 8)) {}

bool RowFolder::fold(const FitControl& control, bool keep, Eigen::MatrixXd& triangle) {
  parallel_for(kHalves, [&](int part) {
    Half& half = halves_[static_cast<std::size_t>(part)];
    half.begin(columns_);
    half.triangle = Eigen::MatrixXd::Zero(columns_, columns_);
    for (Eigen::Index block = first_block(part); block < first_block(part + 1); ++block) {
      Factor factor = append(block, half.triangle);
      carry(factor, half);
      if (keep) half.kept.push_back(std::move(factor));
    }
  });
  if (!control.may_continue(0.7)) return false;
  both_.qr.resize(2 * columns_, columns_);
  both_.qr << halves_[0].triangle, halves_[1].triangle;
  both_.factors = qr_in_place(both_.qr);
  triangle = joined();
  return true;
}

void RowFolder::fold_again(Eigen::MatrixXd& triangle) {
  parallel_for(kHalves, [&](int part) {
    Half& half = halves_[static_cast<std::size_t>(part)];
    half.begin(columns_);
    for (const Factor& factor : half.kept) carry(factor, half);
  });
  triangle = joined();
}

Eigen::Index RowFolder::first_block(int half) const {
  return (sites_.count() + block_rows_ - 1) / block_rows_ * half / kHalves;
}

// Replaces the triangle by that of [triangle; block].
RowFolder::Factor RowFolder::append(Eigen::Index block, Eigen::MatrixXd& triangle) const {
  const Eigen::Index first = block * block_rows_;
  const Eigen::Index rows = std::min(block_rows_, sites_.count() - first);
  const Eigen::Index tail = columns_ - centres_.cols();
  Factor factor{Eigen::MatrixXd(columns_ + rows, columns_), {}, first, rows};
  factor.qr.topRows(columns_) = triangle;
  Eigen::MatrixXd rows_of_block(rows, columns_);
  kernel_matrix(kernel_, points_, centres_, rows_of_block.leftCols(centres_.cols()), first);
  rows_of_block.rightCols(tail) = tail_matrix(tail_degree(kernel_), sites_.points.middleCols(first, rows));
  rows_of_block.array().colwise() *= sites_.row_scale.segment(first, rows).array();
  factor.qr.bottomRows(rows) = rows_of_block;
  factor.factors = qr_in_place(factor.qr);
  triangle = factor.qr.topRows(columns_).triangularView<Eigen::Upper>();
  return factor;
}

void RowFolder::carry(const Factor& factor, Half& half) const {
  Eigen::VectorXd data(columns_ + factor.rows);
  data.head(columns_) = half.data;
  data.tail(factor.rows) = sites_.target_N.segment(factor.first, factor.rows)
                               .cwiseProduct(sites_.row_scale.segment(factor.first, factor.rows));
  apply_transposed_q(factor.qr, factor.factors, data);
  half.data = data.head(columns_);
  half.rest_squared += data.tail(factor.rows).squaredNorm();
}

// Of both halves.
Eigen::MatrixXd RowFolder::joined() const {
  Eigen::VectorXd data(2 * columns_);
  data << halves_[0].data, halves_[1].data;
  apply_transposed_q(both_.qr, both_.factors, data);
  const double rest_squared = halves_[0].rest_squared + halves_[1].rest_squared + data.tail(columns_).squaredNorm();
  Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(columns_ + 1, columns_ + 1);
  triangle.topLeftCorner(columns_, columns_) = both_.qr.topRows(columns_).triangularView<Eigen::Upper>();
  triangle.col(columns_).head(columns_) = data.head(columns_);
  triangle(columns_, columns_) = std::sqrt(rest_squared);
  return triangle;
}

}  // namespace palpate
