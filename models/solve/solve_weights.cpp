#include "models/solve/solve_weights.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/parallel.h"
#include "models/linear/lapack.h"
#include "models/model/rbf/polynomial_tail.h"
#include "models/model/rbf/rbf_evaluate.h"
#include "models/solve/penalised_weights.h"
#include "models/solve/projected_kernel.h"

namespace palpate {
namespace {

// With this many sites for each unknown and no selected smoothing, plain least squares is used. On virtual silicone the
// most likely smoothing, that of a function through all sites, triples the error of 100 centres; with few sites it
// reduces it by two points.
constexpr Eigen::Index kSitesEach = 10;

// The rows are reduced in two halves, one thread each. The number is fixed, so that the result does not depend on the
// number of cores.
constexpr int kHalves = 2;

// The reduced form of the rows so far.
struct HalfOfRows {
  Eigen::MatrixXd triangle;
  Eigen::VectorXd data;       // Q^T f along the triangle's rows
  double rest_squared = 0.0;  // of Q^T f, outside of them
};

// Replaces triangle and data by those of `rows`, which contain the triangle so far as their first rows.
void factorise(Eigen::MatrixXd& rows, Eigen::VectorXd& data, HalfOfRows& half) {
  const Eigen::Index columns = rows.cols();
  const Eigen::MatrixXd factors = qr_in_place(rows);
  apply_transposed_q(rows, factors, data);
  half.triangle = rows.topRows(columns).triangularView<Eigen::Upper>();
  half.data = data.head(columns);
  half.rest_squared += data.tail(data.size() - columns).squaredNorm();
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
  std::array<HalfOfRows, kHalves> halves;
  parallel_for(kHalves, [&](int half) {
    HalfOfRows& mine = halves[static_cast<std::size_t>(half)];
    mine = {Eigen::MatrixXd::Zero(columns, columns), Eigen::VectorXd::Zero(columns)};
    for (Eigen::Index block = blocks * half / kHalves; block < blocks * (half + 1) / kHalves; ++block) {
      const Eigen::Index first = block * block_rows;
      const Eigen::Index rows = std::min(block_rows, sites.count() - first);
      Eigen::MatrixXd rows_of_block(rows, columns);
      kernel_matrix(kernel, points, centres, rows_of_block.leftCols(centres.cols()), first);
      rows_of_block.rightCols(tail) = tail_matrix(tail_degree(kernel), sites.points.middleCols(first, rows));
      rows_of_block.array().colwise() *= sites.row_scale.segment(first, rows).array();
      Eigen::MatrixXd stack(columns + rows, columns);
      stack << mine.triangle, rows_of_block;
      Eigen::VectorXd data(columns + rows);
      data << mine.data, sites.target_N.segment(first, rows).cwiseProduct(sites.row_scale.segment(first, rows));
      factorise(stack, data, mine);
    }
  });
  Eigen::MatrixXd stack(2 * columns, columns);
  stack << halves[0].triangle, halves[1].triangle;
  Eigen::VectorXd data(2 * columns);
  data << halves[0].data, halves[1].data;
  HalfOfRows both;
  both.rest_squared = halves[0].rest_squared + halves[1].rest_squared;
  factorise(stack, data, both);
  Eigen::MatrixXd& triangle = factorised.triangle;
  triangle = Eigen::MatrixXd::Zero(columns + 1, columns + 1);
  triangle.topLeftCorner(columns, columns) = both.triangle;
  triangle.col(columns).head(columns) = both.data;
  triangle(columns, columns) = std::sqrt(both.rest_squared);
  return factorised;
}

Result<FittedRbf> solve_weights(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres) {
  const auto factorised = factorise_rows(sites, kernel, centres);
  if (!factorised) return factorised.error();
  return penalised_weights(*factorised, kernel, centres);
}

}  // namespace palpate
