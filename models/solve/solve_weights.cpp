#include "models/solve/solve_weights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "engine/base/parallel.h"
#include "models/model/rbf/polynomial_tail.h"
#include "models/model/rbf/rbf_evaluate.h"
#include "models/solve/lapack.h"
#include "models/solve/penalised_weights.h"

namespace palpate {
namespace {

// Rounding in the triangle is about 1e-14 of the largest singular value for a
// thousand columns; what lies two decades above is still data.
constexpr double kTruncation = 1e-12;

// The ridge of the largest evidence, see solve_weights.h. `s`: the singular
// values that count, descending; `z`: the data's shares along them; `rest`: the
// squared length of what lies outside; `rows`: how many there are.
double ridge_by_evidence(const Eigen::ArrayXd& s, const Eigen::ArrayXd& z, double rest, double rows) {
  constexpr int kStepsPerDecade = 4;
  constexpr int kLowestDecade = -24;  // of the square: the truncation
  // From a handful of rows, or hardly more than unknowns, a force cannot be told
  // from noise; then the large directions, which carry the mean, stay as they are.
  const int highest_decade = rows < 20.0 + 2.0 * static_cast<double>(s.size()) ? -5 : 0;
  if (s.size() == 0 || !(z.square().sum() > 0.0)) return 0.0;
  double best = 0.0;
  double lowest = std::numeric_limits<double>::infinity();
  for (int step = kLowestDecade * kStepsPerDecade; step <= highest_decade * kStepsPerDecade; ++step) {
    const double lambda = s[0] * s[0] * std::pow(10.0, static_cast<double>(step) / kStepsPerDecade);
    const Eigen::ArrayXd left = lambda / (s.square() + lambda);
    const double cost = rows * std::log((left * z.square()).sum() + rest) - left.log().sum();
    if (cost < lowest) {
      lowest = cost;
      best = lambda;
    }
  }
  return best;
}

// Whether the sites tell the unknowns apart by themselves: many of them, and a ridge
// of next to nothing is the most probable. Then least squares stays as it is, for the
// ridge would only take from the force at first touch, where few sites lie. On
// recordings, virtual and real, 1e-7 of the square of the largest singular value and
// less was seen; with noise that hides the force, 1.
bool sites_decide(double lambda, double largest, double rows, double unknowns) {
  constexpr double kNoiseRules = 1e-6;
  constexpr double kRowsEach = 10.0;
  return rows >= kRowsEach * unknowns && lambda < kNoiseRules * largest * largest;
}

// The rows are folded in two halves, one thread each. Fixed, not the number of
// cores, so that the result is the same everywhere.
constexpr int kHalves = 2;

// What the rows so far have become.
struct HalfOfRows {
  Eigen::MatrixXd triangle;
  Eigen::VectorXd data;       // Q^T f along the triangle's rows
  double rest_squared = 0.0;  // of Q^T f, beyond them
};

// Replaces the triangle by that of `rows`, which has it on top, and the data likewise.
void factorise(Eigen::MatrixXd& rows, Eigen::VectorXd& data, HalfOfRows& folded) {
  const Eigen::Index columns = rows.cols();
  const Eigen::MatrixXd factors = qr_in_place(rows);
  apply_transposed_q(rows, factors, data);
  folded.triangle = rows.topRows(columns).triangularView<Eigen::Upper>();
  folded.data = data.head(columns);
  folded.rest_squared += data.tail(data.size() - columns).squaredNorm();
}

}  // namespace

bool fold_rows(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres, const FitControl& control,
               FoldedRows& folded) {
  folded.sites = sites.count();
  folded.rows = (sites.row_scale.array() > 0.0).count();
  folded.smoothing = sites.smoothing;
  folded.strength = sites.strength;
  const PointArrays points(sites.points);
  const Eigen::Index tail = tail_size(tail_degree(kernel), sites.dimension());
  const Eigen::Index columns = centres.cols() + tail;
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
  if (!control.may_continue(0.7)) return false;
  Eigen::MatrixXd stack(2 * columns, columns);
  stack << halves[0].triangle, halves[1].triangle;
  Eigen::VectorXd data(2 * columns);
  data << halves[0].data, halves[1].data;
  HalfOfRows both;
  both.rest_squared = halves[0].rest_squared + halves[1].rest_squared;
  factorise(stack, data, both);
  Eigen::MatrixXd& triangle = folded.triangle;
  triangle = Eigen::MatrixXd::Zero(columns + 1, columns + 1);
  triangle.topLeftCorner(columns, columns) = both.triangle;
  triangle.col(columns).head(columns) = both.data;
  triangle(columns, columns) = std::sqrt(both.rest_squared);
  return true;
}

Status validate_centres(const Sites& sites, const Eigen::MatrixXd& centres) {
  if (const Status status = validate_sites(sites); !status) return status;
  if (centres.rows() == sites.points.rows() && centres.allFinite()) return {};
  return Error{"centres have " + std::to_string(centres.rows()) + " coordinates or are not finite, expected " +
               std::to_string(sites.points.rows()) + " finite ones, as the sites have"};
}

Result<FittedRbf> solve_folded(const FoldedRows& folded, KernelKind kernel, const Eigen::MatrixXd& centres) {
  if (folded.smoothing && kernel == KernelKind::cubic) return penalised_weights(folded, kernel, centres);
  const BlasThreads one_thread(1);
  const Eigen::Index n = folded.triangle.cols() - 1;
  Eigen::MatrixXd r = folded.triangle.topLeftCorner(n, n);
  Eigen::VectorXd scale = r.colwise().stableNorm().transpose();
  // A column of next to nothing (the kernel of a centre on top of every site)
  // is not scaled up: it would need a weight of 1e20 to matter.
  scale = (scale.array() > 1e-20 * scale.maxCoeff()).select(scale, std::max(scale.maxCoeff(), 1e-300));
  r.array().rowwise() /= scale.transpose().array();
  Svd parts;
  if (!svd(std::move(r), parts))
    return Error{"the singular value decomposition did not converge; check the recording for extreme values"};
  const double smallest = kTruncation * parts.s[0];
  const Eigen::Index rank = (parts.s.array() > smallest && parts.s.array() > 0.0).count();
  Eigen::VectorXd z = parts.u.transpose() * folded.triangle.col(n).head(n);
  const double rho = folded.triangle(n, n);
  const double rest = rho * rho + z.tail(n - rank).squaredNorm();
  const Eigen::ArrayXd kept = parts.s.head(rank);
  const auto rows = static_cast<double>(folded.rows);
  double lambda = ridge_by_evidence(kept, z.head(rank), rest, rows);
  if (lambda > 0.0 && sites_decide(lambda, kept[0], rows, static_cast<double>(n))) lambda = 0.0;
  const Eigen::ArrayXd left = lambda / (kept.square() + lambda);
  const double residual_squared = rest + (left * z.head(rank).array()).square().sum();
  z.head(rank).array() *= kept / (kept.square() + lambda);
  Eigen::VectorXd unknowns = parts.vt.topRows(rank).transpose() * z.head(rank);
  unknowns.array() /= scale.array();
  FittedRbf fitted;
  fitted.function = {kernel, centres, folded.strength * unknowns.head(centres.cols()),
                     folded.strength * unknowns.tail(n - centres.cols())};
  FitReport& report = fitted.report;
  report.centres_asked = report.centres_used = centres.cols();
  report.columns = n;
  report.rank = rank;
  report.condition = parts.s[n - 1] > 0.0 ? parts.s[0] / parts.s[n - 1] : 1e300;
  report.smoothing = lambda > 0.0 ? lambda / (kept[0] * kept[0]) : 0.0;
  report.residual_rms = std::sqrt(residual_squared / static_cast<double>(folded.sites));
  if (rank < n)
    report.notes.push_back("the data determine " + std::to_string(rank) + " of " + std::to_string(n) +
                           " unknowns; the rest took the shortest solution");
  return fitted;
}

Result<FittedRbf> solve_weights(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres,
                                const FitControl& control) {
  if (const Status status = validate_centres(sites, centres); !status) return status.error();
  if (!control.may_continue(0.0)) return interrupted();
  const BlasThreads one_thread(1);
  FoldedRows folded;
  if (!fold_rows(sites, kernel, centres, control, folded)) return interrupted();
  auto fitted = solve_folded(folded, kernel, centres);
  if (!control.may_continue(1.0)) return interrupted();
  return fitted;
}

}  // namespace palpate
