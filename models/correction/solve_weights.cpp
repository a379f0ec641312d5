#include "models/correction/solve_weights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "engine/base/parallel.h"
#include "models/correction/projected_kernel.h"
#include "models/linear/lapack.h"
#include "models/model/kernels.h"

namespace palpate {
namespace {

// Singular values below this share of the largest are rounding.
constexpr double kNothing = 1e-13;
// The rows are reduced in two halves, one thread each. The number is fixed, so that the result does not depend on the
// number of cores.
constexpr int kHalves = 2;

}  // namespace

Eigen::MatrixXd joined_triangles(const Eigen::MatrixXd& above, const Eigen::MatrixXd& below) {
  Eigen::MatrixXd stack(above.rows() + below.rows(), above.cols());
  stack << above, below;
  qr_in_place(stack);
  return stack.topRows(stack.cols()).triangularView<Eigen::Upper>();
}

Eigen::MatrixXd reduced_rows(const Sites& sites, const Eigen::MatrixXd& centres, Eigen::Index first,
                             Eigen::Index count) {
  const PointArrays points(sites.points);
  const Eigen::Index tail = tail_size(tail_degree(sites.kernel), sites.dimension());
  const Eigen::Index columns = tail + centres.cols();
  const Eigen::Index block_rows = std::max<Eigen::Index>(1024, (2 * columns + 9) / 8 * 8);
  const Eigen::Index end = first + count;
  Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(columns + 1, columns + 1);
  while (first < end) {
    // The kernel is computed from a multiple of 8 on.
    const Eigen::Index aligned = first / 8 * 8;
    const Eigen::Index rows = std::min(block_rows, end - aligned);
    Eigen::MatrixXd block(rows, columns + 1);
    block.leftCols(tail) = tail_matrix(tail_degree(sites.kernel), sites.points.middleCols(aligned, rows));
    kernel_matrix(sites.kernel, points, centres, block.middleCols(tail, centres.cols()), aligned);
    block.col(columns) = sites.target_N.segment(aligned, rows);
    block.array().colwise() *= sites.row_scale.segment(aligned, rows).array();
    triangle = joined_triangles(triangle, block.bottomRows(rows - (first - aligned)));
    first = aligned + rows;
  }
  return triangle;
}

SolvedWeights solve_weights(const Sites& sites, const Eigen::MatrixXd& centres) {
  const BlasThreads one_thread(1);
  std::array<Eigen::MatrixXd, kHalves> halves;
  const Eigen::Index middle = sites.count() / kHalves / 8 * 8;
  parallel_for(kHalves, [&](int half) {
    halves[static_cast<std::size_t>(half)] = half == 0 ? reduced_rows(sites, centres, 0, middle)
                                                       : reduced_rows(sites, centres, middle, sites.count() - middle);
  });
  const Eigen::MatrixXd triangle = joined_triangles(halves[0], halves[1]);
  const Eigen::Index n = centres.cols();
  const Eigen::Index tail = triangle.cols() - 1 - n;
  const bool truncated = sites.truncation > 0.0;
  // [G Phi] of the sites, above the rows of the penalty or of the side condition.
  const Eigen::Index below = truncated ? tail : n;
  Eigen::MatrixXd stack = Eigen::MatrixXd::Zero(triangle.rows() + below, tail + n);
  stack.topRows(triangle.rows()) = triangle.leftCols(tail + n);
  auto of_sites = stack.topRightCorner(triangle.rows(), n);
  auto added = stack.bottomRightCorner(below, n);
  Eigen::VectorXd data = Eigen::VectorXd::Zero(stack.rows());
  data.head(triangle.rows()) = triangle.rightCols(1);
  std::optional<ProjectedKernel> projected;
  if (n > 0 && truncated) {
    added = tail_matrix(tail_degree(sites.kernel), centres).transpose();
  } else if (n > 0) {
    projected.emplace(sites.kernel, centres, Eigen::VectorXd::Ones(n));
    projected->project_rows(of_sites);
    const auto root = projected->cholesky(0.0);
    if (root) added = root->lower.transpose().triangularView<Eigen::Upper>();
    added *= std::sqrt(sites.smoothing);
  }
  Eigen::VectorXd unit = Eigen::VectorXd::Ones(stack.cols());
  if (!truncated) {
    // Columns of length 1.
    unit = stack.colwise().stableNorm().transpose();
    unit = (unit.array() > 0.0).select(unit.cwiseInverse(), 1.0);
  }
  const double smallest = truncated ? sites.truncation : kNothing;
  const SingularValues values = singular_values(stack * unit.asDiagonal());
  const Eigen::VectorXd unknowns = values.solve(data, smallest).cwiseProduct(unit);
  const Eigen::VectorXd weights = unknowns.tail(n);
  return {{sites.kernel, centres, projected ? projected->project(weights) : weights, unknowns.head(tail)},
          values.rank(smallest),
          values.condition_number(smallest)};
}

Result<SolvedWeights> solve_direct(const Sites& sites, const FitControl& control) {
  if (sites.count() > kMostDirectSites)
    return Error{"a direct fit of " + std::to_string(sites.count()) + " sites is too large, at most " +
                 std::to_string(kMostDirectSites) + "; thin the recording further or use greedy"};
  if (!control.may_continue(0.0)) return interrupted();
  const BlasThreads threads(thread_count());
  const ProjectedKernel kernel(sites.kernel, sites.points, sites.row_scale);
  if (!control.may_continue(0.1)) return interrupted();
  const auto factor = kernel.cholesky(sites.smoothing, control.part(0.1, 0.95));
  if (!factor && !control.may_continue(0.95)) return interrupted();
  if (!factor) return Error{"the kernel matrix could not be factorised; check the recording for extreme values"};
  if (!control.may_continue(0.95)) return interrupted();
  const Eigen::VectorXd data = sites.target_N.cwiseProduct(sites.row_scale);
  Eigen::VectorXd u = kernel.project(data);
  cholesky_solve(factor->lower, u);
  u = kernel.project(u);
  // S G d = S f - K u - smoothing u, whose last term is orthogonal to the columns of S G.
  const Eigen::VectorXd tail = kernel.tail_of(data - kernel.multiply_kernel(u));
  return SolvedWeights{
      {sites.kernel, sites.points, definiteness_sign(sites.kernel) * u.cwiseProduct(sites.row_scale), tail},
      sites.count(),
      cholesky_condition(factor->lower, factor->norm)};
}

}  // namespace palpate
