#include "models/solve/solve_weights.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/base/parallel.h"
#include "models/model/rbf/polynomial_tail.h"
#include "models/model/rbf/rbf_evaluate.h"
#include "models/solve/projected_kernel.h"
#include "models/solve/truncated_svd.h"

namespace palpate {
namespace {

// With this many sites for each unknown and no selected smoothing, plain least squares is used. On virtual silicone the
// most likely smoothing, that of a function through all sites, triples the error of 100 centres; with few sites it
// reduces it by two points.
constexpr Eigen::Index kSitesEach = 10;

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

// Eigenvalues below this share of the largest are rounding.
constexpr double kNothing = 1e-13;
// Relative to the norm of a column. Its square is a thousandth of the value at which 100 centres begin to lose
// accuracy.
constexpr double kRidge = 1e-6;

Eigen::MatrixXd kernel_at_centres(KernelKind kernel, const Eigen::MatrixXd& centres) {
  Eigen::MatrixXd values(centres.cols(), centres.cols());
  kernel_matrix(kernel, PointArrays(centres), centres, values);
  return values;
}

// Upper C with C^T C = the penalty, for the directions of Z that give a function other than 0 (opposite weights of
// equal centres give 0).
struct Root {
  std::optional<Eigen::MatrixXd> directions;  // orthonormal; none: all directions
  Eigen::MatrixXd upper;
};

Root root_of(const Eigen::MatrixXd& penalty) {
  Eigen::MatrixXd factor = penalty;
  if (cholesky_in_place(factor)) {
    const Eigen::VectorXd pivots = factor.diagonal().cwiseAbs2();
    if (pivots.size() == 0 || pivots.minCoeff() > kNothing * pivots.maxCoeff()) {
      return {std::nullopt, factor.triangularView<Eigen::Lower>().toDenseMatrix().transpose()};
    }
  }
  Eigen::MatrixXd vectors = penalty;
  Eigen::VectorXd values;
  if (!symmetric_eigen(vectors, values)) values.setZero();
  const Eigen::Index count = (values.array() > kNothing * values.maxCoeff()).count();
  return {vectors.rightCols(count), values.tail(count).cwiseSqrt().asDiagonal()};
}

// Least squares of the triangle [R z] with columns scaled to length 1; directions at the level of rounding get 0.
struct TriangleSolution {
  Eigen::VectorXd unknowns;
  double condition = 0.0;
};

TriangleSolution solve_scaled(const Eigen::MatrixXd& triangle) {
  const Eigen::Index n = triangle.cols() - 1;
  Eigen::MatrixXd r = triangle.topLeftCorner(n, n);
  Eigen::VectorXd scale = r.colwise().stableNorm().transpose();
  scale = (scale.array() > 0.0).select(scale, 1.0);
  r.array().rowwise() /= scale.transpose().array();
  const Eigen::VectorXd diagonal = r.diagonal().cwiseAbs();
  TriangleSolution solution;
  if (diagonal.minCoeff() > kNothing * diagonal.maxCoeff()) {
    solution.unknowns = r.triangularView<Eigen::Upper>().solve(triangle.col(n).head(n)).cwiseQuotient(scale);
    solution.condition = diagonal.maxCoeff() / diagonal.minCoeff();
    return solution;
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> pivoted;
  pivoted.setThreshold(kNothing);
  pivoted.compute(r);
  solution.unknowns = pivoted.solve(triangle.col(n).head(n)).cwiseQuotient(scale);
  const double least = std::abs(pivoted.matrixQR()(n - 1, n - 1));
  solution.condition = least > 0.0 ? pivoted.maxPivot() / least : 1e300;
  return solution;
}

// The product of the first `count` reflectors I - tau w w^T as I - u v^T.
void gather_reflectors(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr, Eigen::Index count, PenaltySpace& space) {
  const Eigen::Index n = qr.rows();
  space.u.resize(n, count);
  space.v = Eigen::MatrixXd::Zero(n, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    auto w = space.v.col(k);
    w(k) = 1.0;
    w.tail(n - k - 1) = qr.matrixQR().col(k).tail(n - k - 1);
    const Eigen::VectorXd along = space.v.leftCols(k).transpose() * w;
    space.u.col(k) = qr.hCoeffs()(k) * (w - space.u.leftCols(k) * along);
  }
}

// Z times the unknowns.
Eigen::VectorXd weights_of(const Eigen::VectorXd& unknowns, const PenaltySpace& space) {
  Eigen::VectorXd weights = -space.u * (space.v.bottomRows(space.free).transpose() * unknowns);
  weights.tail(space.free) += unknowns;
  return weights;
}

}  // namespace

Result<FactorisedRows> factorise_rows(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres) {
  const BlasThreads one_thread(1);
  FactorisedRows factorised{{}, sites.count(), 0, 0.0, sites.strength, sites.as_2009};
  const PointArrays points(sites.points);
  const Eigen::Index tail = tail_size(tail_degree(kernel), sites.dimension());
  const Eigen::Index columns = centres.cols() + tail;
  if (!is_smoothing_selected(sites, kernel))
    factorised.plain_unknowns_limit = (sites.row_scale.array() > 0.0).count() / kSitesEach;
  if (columns > factorised.plain_unknowns_limit && !sites.as_2009) {
    const auto smoothing = smoothing_of(sites, kernel);
    if (!smoothing) return smoothing.error();
    factorised.smoothing = *smoothing;
  }
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
      rows_of_block.leftCols(tail) = tail_matrix(tail_degree(kernel), sites.points.middleCols(first, rows));
      kernel_matrix(kernel, points, centres, rows_of_block.middleCols(tail, centres.cols()), first);
      rows_of_block.col(columns) = sites.target_N.segment(first, rows);
      rows_of_block.array().colwise() *= sites.row_scale.segment(first, rows).array();
      triangle = triangle_of(triangle, rows_of_block);
    }
  });
  factorised.triangle = triangle_of(halves[0], halves[1]);
  return factorised;
}

PenaltySpace penalty_space(KernelKind kernel, const Eigen::MatrixXd& centres) {
  const Eigen::Index n = centres.cols();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(tail_matrix(tail_degree(kernel), centres));
  PenaltySpace space;
  gather_reflectors(qr, qr.rank(), space);
  space.free = n - qr.rank();
  Eigen::MatrixXd product = definiteness_sign(kernel) * kernel_at_centres(kernel, centres);
  multiply_by_basis(product, space);
  Eigen::MatrixXd turned = product.leftCols(space.free).transpose();
  multiply_by_basis(turned, space);
  const auto penalty = turned.leftCols(space.free);
  space.penalty = 0.5 * (penalty + penalty.transpose());
  return space;
}

void multiply_by_basis(MatrixRef matrix, const PenaltySpace& space) {
  const Eigen::Index rank = space.v.cols();
  const Eigen::Index free = space.free;
  Eigen::MatrixXd along(matrix.rows(), rank);
  multiply(matrix, false, space.u, false, 1.0, 0.0, along);
  for (Eigen::Index j = 0; j < free; ++j) matrix.col(j) = matrix.col(j + rank);
  multiply(along, false, space.v.bottomRows(free), true, -1.0, 1.0, matrix.leftCols(free));
}

FittedRbf penalised_weights(const FactorisedRows& factorised, KernelKind kernel, const Eigen::MatrixXd& centres) {
  if (factorised.as_2009) return truncated_weights(factorised, kernel, centres);
  const BlasThreads one_thread(1);
  const Eigen::MatrixXd& triangle = factorised.triangle;
  const Eigen::Index n = centres.cols();
  const Eigen::Index tail = triangle.cols() - 1 - n;
  const auto kernels = triangle.middleCols(tail, n);
  PenaltySpace space;
  Root root;
  const bool plain = n + tail <= factorised.plain_unknowns_limit;
  if (!plain && n > 0) {
    space = penalty_space(kernel, centres);
    root = root_of(space.penalty);
    root.upper *= std::sqrt(factorised.smoothing);
  } else if (n > 0) {
    space = {n, {}, Eigen::MatrixXd(n, 0), Eigen::MatrixXd(n, 0)};
    root.upper = (kRidge * kernels.colwise().norm()).asDiagonal();
  }
  const Eigen::Index free = root.upper.cols();
  const Eigen::Index columns = free + tail + 1;
  // [K Z, G, f] of the sites above, the root of the penalty below.
  Eigen::MatrixXd stack = Eigen::MatrixXd::Zero(triangle.rows() + free, columns);
  if (free > 0) {
    Eigen::MatrixXd product = kernels;
    multiply_by_basis(product, space);
    const auto projected = product.leftCols(space.free);
    stack.topLeftCorner(triangle.rows(), free) =
        root.directions ? Eigen::MatrixXd(projected * *root.directions) : projected;
    stack.bottomLeftCorner(free, free) = root.upper;
  }
  stack.block(0, free, triangle.rows(), tail) = triangle.leftCols(tail);
  stack.block(0, free + tail, triangle.rows(), 1) = triangle.rightCols(1);
  if (stack.rows() > columns) {
    qr_in_place(stack);
  }
  const Eigen::MatrixXd reduced = stack.topRows(columns).triangularView<Eigen::Upper>();
  const TriangleSolution solution = solve_scaled(reduced);
  Eigen::VectorXd unknowns = solution.unknowns.head(free);
  if (root.directions) unknowns = *root.directions * unknowns;
  FittedRbf fitted;
  fitted.function = {kernel, centres, free > 0 ? weights_of(unknowns, space) : Eigen::VectorXd::Zero(n),
                     solution.unknowns.tail(tail)};
  FitReport& report = fitted.report;
  report.centres_used = n;
  report.condition = solution.condition;
  report.smoothing = plain ? 0.0 : factorised.smoothing;
  const Eigen::VectorXd rest =
      triangle.rightCols(1) - kernels * fitted.function.weights - triangle.leftCols(tail) * fitted.function.tail;
  report.residual_rms = std::sqrt(rest.squaredNorm() / static_cast<double>(factorised.sites));
  fitted.function.weights *= factorised.strength;
  fitted.function.tail *= factorised.strength;
  return fitted;
}

Result<FittedRbf> solve_weights(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres) {
  const auto factorised = factorise_rows(sites, kernel, centres);
  if (!factorised) return factorised.error();
  return penalised_weights(*factorised, kernel, centres);
}

}  // namespace palpate
