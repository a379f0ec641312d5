#include "models/solve/solve_weights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/base/parallel.h"
#include "models/linear/lapack.h"
#include "models/model/rbf/polynomial_tail.h"
#include "models/solve/projected_kernel.h"

namespace palpate {
namespace {

// Singular values below this share of the largest are rounding.
constexpr double kNothing = 1e-13;
// The rows are reduced in two halves, one thread each. The number is fixed, so that the result does not depend on the
// number of cores.
constexpr int kHalves = 2;

// The R factor of two blocks of rows.
Eigen::MatrixXd triangle_of(const Eigen::MatrixXd& above, const Eigen::MatrixXd& below) {
  Eigen::MatrixXd stack(above.rows() + below.rows(), above.cols());
  stack << above, below;
  qr_in_place(stack);
  return stack.topRows(stack.cols()).triangularView<Eigen::Upper>();
}

// The R factor of row_scale * (G Phi f), tail + n + 1 columns: the tail, the kernel at the n centres and the data.
Eigen::MatrixXd reduced_rows(const Sites& sites, const Eigen::MatrixXd& centres) {
  const PointArrays points(sites.points);
  const Eigen::Index tail = tail_size(tail_degree(sites.kernel), sites.dimension());
  const Eigen::Index columns = tail + centres.cols();
  const Eigen::Index block_rows = std::max<Eigen::Index>(1024, (2 * columns + 9) / 8 * 8);
  const Eigen::Index blocks = (sites.count() + block_rows - 1) / block_rows;
  std::array<Eigen::MatrixXd, kHalves> halves;
  parallel_for(kHalves, [&](int half) {
    Eigen::MatrixXd& triangle = halves[static_cast<std::size_t>(half)];
    triangle = Eigen::MatrixXd::Zero(columns + 1, columns + 1);
    for (Eigen::Index block = blocks * half / kHalves; block < blocks * (half + 1) / kHalves; ++block) {
      const Eigen::Index first = block * block_rows;
      const Eigen::Index rows = std::min(block_rows, sites.count() - first);
      Eigen::MatrixXd rows_of_block(rows, columns + 1);
      rows_of_block.leftCols(tail) = tail_matrix(tail_degree(sites.kernel), sites.points.middleCols(first, rows));
      kernel_matrix(sites.kernel, points, centres, rows_of_block.middleCols(tail, centres.cols()), first);
      rows_of_block.col(columns) = sites.target_N.segment(first, rows);
      rows_of_block.array().colwise() *= sites.row_scale.segment(first, rows).array();
      triangle = triangle_of(triangle, rows_of_block);
    }
  });
  return triangle_of(halves[0], halves[1]);
}

}  // namespace

RbfFunction solve_weights(const Sites& sites, const Eigen::MatrixXd& centres) {
  const BlasThreads one_thread(1);
  const Eigen::MatrixXd triangle = reduced_rows(sites, centres);
  const Eigen::Index n = centres.cols();
  const Eigen::Index tail = triangle.cols() - 1 - n;
  // [G Phi] of the sites, above the rows of the penalty or of the side condition.
  const Eigen::Index below = sites.as_2009 ? tail : n;
  Eigen::MatrixXd stack = Eigen::MatrixXd::Zero(triangle.rows() + below, tail + n);
  stack.topRows(triangle.rows()) = triangle.leftCols(tail + n);
  auto of_sites = stack.topRightCorner(triangle.rows(), n);
  auto added = stack.bottomRightCorner(below, n);
  Eigen::VectorXd data = Eigen::VectorXd::Zero(stack.rows());
  data.head(triangle.rows()) = triangle.rightCols(1);
  std::optional<ProjectedKernel> projected;
  if (n > 0 && sites.as_2009) {
    added = tail_matrix(tail_degree(sites.kernel), centres).transpose();
  } else if (n > 0) {
    projected.emplace(sites.kernel, centres, Eigen::VectorXd::Ones(n));
    projected->project_rows(of_sites);
    const auto root = projected->cholesky(0.0);
    if (root) added = root->transpose().triangularView<Eigen::Upper>();
    added *= std::sqrt(sites.smoothing);
  }
  Eigen::VectorXd unit = Eigen::VectorXd::Ones(stack.cols());
  double smallest = static_cast<double>(stack.rows()) * std::numeric_limits<double>::epsilon();
  if (!sites.as_2009) {
    // Columns of length 1.
    unit = stack.colwise().stableNorm().transpose();
    unit = (unit.array() > 0.0).select(unit.cwiseInverse(), 1.0);
    smallest = kNothing;
  }
  const Eigen::VectorXd unknowns = least_squares(stack * unit.asDiagonal(), data, smallest).cwiseProduct(unit);
  const Eigen::VectorXd weights = unknowns.tail(n);
  return {sites.kernel, centres, projected ? projected->project(weights) : weights, unknowns.head(tail)};
}

}  // namespace palpate
