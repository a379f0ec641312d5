#include "models/correction/algebra.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "engine/base/parallel.h"
#include "models/linear/lapack.h"
#include "models/model/kernels.h"

namespace palpate {
namespace {

Eigen::VectorXd factor_product(const Eigen::MatrixXd& lower, const Eigen::VectorXd& v) {
  const Eigen::VectorXd upper = lower.transpose().triangularView<Eigen::Upper>() * v;
  return lower.triangularView<Eigen::Lower>() * upper;
}

// The largest eigenvalue by the power method, or with the inverse of `multiply` the inverse of the smallest.
double largest_eigenvalue(Eigen::Index size, const std::function<void(Eigen::VectorXd&)>& multiply) {
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(size, 1.0, 2.0);
  for (int step = 0; step < 5; ++step) {
    x.normalize();
    multiply(x);
  }
  return x.norm();
}

}  // namespace

ProjectedKernel::ProjectedKernel(KernelKind kernel, const Eigen::MatrixXd& points, const Eigen::VectorXd& scale)
    : kernel_(kernel), points_(points), arrays_(points), scale_(scale) {
  // Directions weaker than this come from a constant or repeated feature.
  constexpr double kWeakestDirection = 1e-10;
  Eigen::MatrixXd tail = scale.asDiagonal() * tail_matrix(tail_degree(kernel), points);
  tail_scale_ = tail.colwise().norm().transpose();
  tail_scale_ = (tail_scale_.array() > 0.0).select(tail_scale_, 1.0);
  tail.array().rowwise() /= tail_scale_.transpose().array();
  tail_.setThreshold(kWeakestDirection);
  tail_.compute(tail);
  q_ = tail_.householderQ() * Eigen::MatrixXd::Identity(points.cols(), tail_.rank());
  Eigen::MatrixXd kq(q_.rows(), q_.cols());
  for (Eigen::Index k = 0; k < q_.cols(); ++k) kq.col(k) = multiply_kernel(q_.col(k));
  const Eigen::MatrixXd inner = q_.transpose() * kq;
  half_update_ = kq - 0.5 * q_ * inner;
  // All entries on the diagonal of the kernel are equal: 0, but for the least distance of the vector loops.
  const double diagonal =
      definiteness_sign(kernel) * kernel_product(kernel, points.leftCols(1), Eigen::VectorXd::Ones(1))(0);
  const double trace = diagonal * scale.squaredNorm() - 2.0 * q_.cwiseProduct(half_update_).sum();
  const double size = inner.norm();
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * (std::abs(trace) + size);
  const bool nothing = !(trace > 1e3 * rounding);
  mean_eigenvalue_ = nothing ? std::max(1.0, size) : trace / static_cast<double>(points.cols());
  smallest_smoothing_ = nothing ? mean_eigenvalue_ : rounding;
}

Eigen::VectorXd ProjectedKernel::multiply_kernel(const Eigen::VectorXd& v) const {
  const Eigen::VectorXd product = kernel_product(kernel_, points_, v.cwiseProduct(scale_));
  return definiteness_sign(kernel_) * product.cwiseProduct(scale_);
}

void ProjectedKernel::project_rows(MatrixRef matrix) const {
  Eigen::MatrixXd along(matrix.rows(), q_.cols());
  multiply(matrix, false, q_, false, 1.0, 0.0, along);
  multiply(along, false, q_, true, -1.0, 1.0, matrix);
}

void ProjectedKernel::entries(const std::vector<Eigen::Index>& sites, Eigen::Index first, const Eigen::MatrixXd& update,
                              MatrixRef out) const {
  const Eigen::Index rows = out.rows();
  kernel_matrix(kernel_, arrays_, points_(Eigen::all, sites), out, first);
  out.array().colwise() *= scale_.segment(first, rows).array();
  out.array().rowwise() *= definiteness_sign(kernel_) * scale_(sites).transpose().array();
  multiply(q_.middleRows(first, rows), false, update(sites, Eigen::all), true, -1.0, 1.0, out);
  multiply(update.middleRows(first, rows), false, q_(sites, Eigen::all), true, -1.0, 1.0, out);
}

Eigen::MatrixXd ProjectedKernel::matrix(double fill, double smoothing) const {
  const Eigen::Index count = points_.cols();
  const Eigen::MatrixXd update = half_update_ - 0.5 * fill * q_;
  Eigen::MatrixXd matrix(count, count);
  const BlasThreads one_thread(1);
  parallel_for(static_cast<int>((count + kBlock - 1) / kBlock), [&](int block) {
    const Eigen::Index first = block * kBlock;
    std::vector<Eigen::Index> sites(static_cast<std::size_t>(std::min(kBlock, count - first)));
    std::iota(sites.begin(), sites.end(), first);
    entries(sites, first, update, matrix.block(first, first, count - first, static_cast<Eigen::Index>(sites.size())));
  });
  matrix.diagonal().array() += smoothing;
  return matrix;
}

Eigen::MatrixXd ProjectedKernel::low_rank(double smoothing) const {
  // Where the trace of the rest is 64 times the smoothing, conjugate gradients take about 12 steps; at 40 times that
  // trace they take as long as the whole factor (measured on the virtual materials; the solution is the same).
  const double enough = 64.0 * smoothing;
  const Eigen::Index count = points_.cols(), most = count / 8;
  const auto for_rows = [&](const auto& work) {
    parallel_for(static_cast<int>((count + kBlockRows - 1) / kBlockRows),
                 [&](int part) { work(part * kBlockRows, std::min(kBlockRows, count - part * kBlockRows)); });
  };
  Eigen::MatrixXd factor(count, most + kBlock), fresh(count, kBlock);
  Eigen::VectorXd rest = -2.0 * q_.cwiseProduct(half_update_).rowwise().sum();  // of the diagonal, which is 0 in K
  std::vector<Eigen::Index> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  Eigen::Index rank = 0;
  while (rank < most && rest.sum() > enough) {
    std::ranges::nth_element(order, order.begin() + kBlock, std::ranges::greater{},
                             [&](Eigen::Index site) { return std::pair(rest(site), site); });
    const std::vector<Eigen::Index> candidates(order.begin(), order.begin() + kBlock);
    const Eigen::MatrixXd before = factor(candidates, Eigen::seqN(0, rank));
    for_rows([&](Eigen::Index first, Eigen::Index rows) {
      entries(candidates, first, half_update_, fresh.middleRows(first, rows));
      multiply(factor.block(first, 0, rows, rank), false, before, true, -1.0, 1.0, fresh.middleRows(first, rows));
    });
    // The candidates that are still half as far from the others before them as the first.
    Eigen::MatrixXd own = fresh(candidates, Eigen::all);
    const std::vector<int> pivots = cholesky_pivots(own, 0.5 * own.diagonal().maxCoeff());
    const auto added = static_cast<Eigen::Index>(pivots.size());
    if (added == 0) break;
    for_rows([&](Eigen::Index first, Eigen::Index rows) {
      auto part = factor.block(first, rank, rows, added);
      part = fresh(Eigen::seqN(first, rows), pivots);
      solve_triangle(own.topLeftCorner(added, added), part);
      rest.segment(first, rows) = (rest.segment(first, rows) - part.rowwise().squaredNorm()).cwiseMax(0.0);
    });
    rank += added;
  }
  factor.conservativeResize(Eigen::NoChange, rest.sum() < 40.0 * enough ? rank : 0);
  return factor;
}

std::optional<ProjectedKernel::Solution> ProjectedKernel::iterate(const Eigen::VectorXd& data, double smoothing,
                                                                  const FitControl& control) const {
  // With this residual forces differ from those of a factorisation by less than 1e-9 N, its own error.
  constexpr double kResidual = 1e-12;
  constexpr int kMostSteps = 80;
  const BlasThreads one_thread(1);
  const Eigen::MatrixXd factor = low_rank(smoothing);
  if (factor.cols() == 0) return std::nullopt;
  Eigen::MatrixXd inner(factor.cols(), factor.cols());
  gram(factor, inner);
  inner.diagonal().array() += smoothing;
  if (!cholesky_in_place(inner)) return std::nullopt;
  Eigen::VectorXd x(factor.cols());
  const auto of_factor = [&](Eigen::VectorXd& v) { v = factor_product(inner, v); };
  Solution solution{Eigen::VectorXd::Zero(data.size()), largest_eigenvalue(x.size(), of_factor) / smoothing};
  Eigen::VectorXd residual = project(data), direction = Eigen::VectorXd::Zero(data.size());
  const double enough = kResidual * residual.norm();
  double before = 1.0;
  for (int step = 0; step < kMostSteps && control.may_continue(); ++step) {
    if (residual.norm() <= enough) return solution;
    multiply(factor, true, residual, false, 1.0, 0.0, x);
    cholesky_solve(inner, x);
    Eigen::VectorXd z = residual;
    multiply(factor, false, x, false, -1.0, 1.0, z);
    z = project(z) / smoothing;
    const double size = residual.dot(z);
    direction = z + size / before * direction;
    before = size;
    const Eigen::VectorXd product = project(multiply_kernel(direction)) + smoothing * direction;
    const double length = size / direction.dot(product);
    solution.u += length * direction;
    residual -= length * product;
  }
  return std::nullopt;
}

std::optional<Eigen::MatrixXd> ProjectedKernel::cholesky(double smoothing, const FitControl& control) const {
  smoothing = std::max(smoothing, smallest_smoothing_);
  for (int attempt = 0; attempt < 8; ++attempt, smoothing *= 10.0) {
    Eigen::MatrixXd lower = matrix(mean_eigenvalue_, smoothing);
    if (cholesky_in_place(lower, control)) return lower;
    if (!control.may_continue()) return std::nullopt;
  }
  return std::nullopt;
}

std::optional<ProjectedKernel::Solution> ProjectedKernel::solve(const Eigen::VectorXd& data, double smoothing,
                                                                const FitControl& control) const {
  if (points_.cols() > kFactorisedSites) {
    if (auto found = iterate(data, std::max(smoothing, smallest_smoothing_), control.at(0.0))) return found;
  }
  const BlasThreads threads(thread_count());
  const auto lower = cholesky(smoothing, control);
  if (!lower) return std::nullopt;
  Eigen::VectorXd u = project(data);
  cholesky_solve(*lower, u);
  const double largest = largest_eigenvalue(u.size(), [&](Eigen::VectorXd& v) { v = factor_product(*lower, v); });
  return Solution{project(u), largest * largest_eigenvalue(u.size(), [&](auto& v) { cholesky_solve(*lower, v); })};
}

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

FittedCorrection solve_weights(const Sites& sites, const Eigen::MatrixXd& centres) {
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
    if (root) added = root->transpose().triangularView<Eigen::Upper>();
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
  return {std::make_shared<const RbfCorrection>(RbfFunction{
              sites.kernel, centres, projected ? projected->project(weights) : weights, unknowns.head(tail)}),
          {},
          values.rank(smallest),
          values.condition_number(smallest)};
}

Result<FittedCorrection> solve_direct(const Sites& sites, const FitControl& control) {
  if (sites.count() > kMostDirectSites)
    return Error{"a direct fit of " + std::to_string(sites.count()) + " sites is too large, at most " +
                 std::to_string(kMostDirectSites) + "; thin the recording further or use greedy"};
  if (!control.may_continue(0.0)) return interrupted();
  const ProjectedKernel kernel(sites.kernel, sites.points, sites.row_scale);
  if (!control.may_continue(0.1)) return interrupted();
  const Eigen::VectorXd data = sites.target_N.cwiseProduct(sites.row_scale);
  const auto solved = kernel.solve(data, sites.smoothing, control.part(0.1, 0.95));
  if (!control.may_continue(0.95)) return interrupted();
  if (!solved) return Error{"the kernel matrix could not be factorised; check the recording for extreme values"};
  // S G d = S f - K u - smoothing u, whose last term is orthogonal to the columns of S G.
  const Eigen::VectorXd tail = kernel.tail_of(data - kernel.multiply_kernel(solved->u));
  return FittedCorrection{
      std::make_shared<const RbfCorrection>(RbfFunction{
          sites.kernel, sites.points, definiteness_sign(sites.kernel) * solved->u.cwiseProduct(sites.row_scale), tail}),
      {},
      sites.count(),
      solved->condition_number};
}

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

CandidateGains::CandidateGains(const Sites& sites)
    : sites_(sites), points_(sites.points), candidates_(static_cast<std::size_t>(sites.count())) {}

Eigen::MatrixXd CandidateGains::columns(std::span<const Eigen::Index> sites) const {
  Eigen::MatrixXd values(sites_.count(), static_cast<Eigen::Index>(sites.size()));
  kernel_matrix(sites_.kernel, points_, sites_.points(Eigen::all, sites), values);
  values.array().colwise() *= sites_.row_scale.array();
  return values;
}

Eigen::Index CandidateGains::least_known(std::span<const Eigen::Index> sites) const {
  const auto known = [&](Eigen::Index site) { return candidates_[static_cast<std::size_t>(site)].known; };
  return known(std::ranges::min(sites, {}, known));
}

void CandidateGains::update(std::span<const Eigen::Index> distinct, const OrthogonalBasis& basis) {
  constexpr std::size_t kGroup = 32;  // sites at a time, whose columns stay in the cache
  // A group costs as much as its site with the most new directions, so that equal ones are put together.
  std::vector<Eigen::Index> sorted(distinct.begin(), distinct.end());
  std::ranges::stable_sort(sorted, {}, [&](Eigen::Index site) { return candidate(site).known; });
  const std::span<const Eigen::Index> sites = sorted;
  const auto all = basis.data_and_columns();
  // Those that one of the sites lacks, scaled instead of the kernel columns.
  const Eigen::MatrixXd directions = sites_.row_scale.asDiagonal() * all.rightCols(all.cols() - least_known(sites));
  const auto groups = static_cast<int>((sites.size() + kGroup - 1) / kGroup);
  parallel_for(groups, [&](int group) {
    const std::size_t first = static_cast<std::size_t>(group) * kGroup;
    const auto some = sites.subspan(first, std::min(kGroup, sites.size() - first));
    update_group(some, directions, basis);
    recompute_cancelled(some, basis);
  });
}

void CandidateGains::update_group(std::span<const Eigen::Index> sites, const Eigen::MatrixXd& directions,
                                  const OrthogonalBasis& basis) {
  const auto count = static_cast<Eigen::Index>(sites.size());
  const Eigen::MatrixXd centres = sites_.points(Eigen::all, sites);
  const Eigen::Index known = least_known(sites);
  const auto fresh = directions.rightCols(basis.size() + 1 - known);
  Eigen::MatrixXd shares = Eigen::MatrixXd::Zero(count, fresh.cols());
  Eigen::VectorXd lengths = Eigen::VectorXd::Zero(count);
  Eigen::MatrixXd memory(kBlockRows, count);
  for (Eigen::Index row = 0; row < sites_.count(); row += kBlockRows) {
    const Eigen::Index rows = std::min(kBlockRows, sites_.count() - row);
    auto block = memory.topRows(rows);
    kernel_matrix(sites_.kernel, points_, centres, block, row);
    multiply(block, true, fresh.middleRows(row, rows), false, 1.0, 1.0, shares);
    if (known > 0) continue;
    lengths += (sites_.row_scale.segment(row, rows).asDiagonal() * block).colwise().squaredNorm().transpose();
  }
  for (Eigen::Index j = 0; j < count; ++j) {
    SiteGain& one = candidate(sites[static_cast<std::size_t>(j)]);
    if (one.known == 0) {
      one.length = one.outside = one.exact = lengths(j);
      one.correlation = shares(j, 0);
    }
    const Eigen::Index lacking = basis.size() - std::max<Eigen::Index>(0, one.known - 1);
    const Eigen::VectorXd along = shares.row(j).tail(lacking);
    one.outside -= along.squaredNorm();
    one.correlation -= along.dot(basis.shares().tail(lacking));
    one.known = basis.size() + 1;
  }
}

void CandidateGains::recompute_cancelled(std::span<const Eigen::Index> sites, const OrthogonalBasis& basis) {
  // The error of |c'|^2 after a subtraction is about 2e-14 |c'| |c|, so that above this multiple of |c'| |c| (of the
  // last full |c'|) it is below 1 %.
  constexpr double kCancelled = 2e-12;
  constexpr double kInsideBasis = 1e-20;  // relative to |c|^2
  std::vector<Eigen::Index> cancelled;
  std::copy_if(sites.begin(), sites.end(), std::back_inserter(cancelled), [&](Eigen::Index site) {
    const SiteGain& one = candidate(site);
    return one.exact > 0.0 && one.outside <= kCancelled * std::sqrt(one.exact * one.length);
  });
  if (cancelled.empty()) return;
  Eigen::MatrixXd parts = columns(cancelled);
  basis.project_out(parts);
  for (std::size_t j = 0; j < cancelled.size(); ++j) {
    SiteGain& one = candidate(cancelled[j]);
    const auto part = parts.col(static_cast<Eigen::Index>(j));
    const double squared = part.squaredNorm();
    one.outside = one.exact = squared > kInsideBasis * one.length ? squared : 0.0;
    one.correlation = part.dot(basis.residual());
  }
}

}  // namespace palpate
