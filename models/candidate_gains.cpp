#include "models/candidate_gains.h"

#include <algorithm>
#include <array>

#include "models/lapack.h"
#include "models/parallel.h"

namespace palpate {
namespace {

// Candidates at a time and rows at a time: a block of columns, 1 MB, stays in
// the second-level cache between its computation and its use.
constexpr Eigen::Index kBatch = 128;
constexpr Eigen::Index kRows = 1024;
// Sums are taken per part, then in order: the same for any number of cores.
constexpr int kParts = 4;

}  // namespace

CandidateGains::CandidateGains(const Sites& sites, KernelKind kernel)
    : sites_(sites), kernel_(kernel), points_(sites.points) {}

Eigen::VectorXd CandidateGains::column(Eigen::Index site) const {
  Eigen::MatrixXd values(sites_.count(), 1);
  kernel_matrix(kernel_, points_, sites_.points.col(site), values);
  return values.col(0).cwiseProduct(sites_.row_scale);
}

CandidateParts CandidateGains::evaluate(const std::vector<Eigen::Index>& candidates,
                                        const OrthogonalBasis& basis) const {
  const auto count = static_cast<Eigen::Index>(candidates.size());
  CandidateParts parts{Eigen::VectorXd(count), Eigen::VectorXd(count), Eigen::VectorXd(count)};
  for (Eigen::Index first = 0; first < count; first += kBatch)
    evaluate_batch(candidates, first, std::min(kBatch, count - first), basis, parts);
  for (Eigen::Index j = 0; j < count; ++j)
    if (parts.outside_squared[j] <= kCancelled * parts.length_squared[j])
      recompute(candidates[static_cast<std::size_t>(j)], j, basis, parts);
  return parts;
}

void CandidateGains::evaluate_batch(const std::vector<Eigen::Index>& candidates, Eigen::Index first,
                                    Eigen::Index count, const OrthogonalBasis& basis, CandidateParts& out) const {
  Eigen::MatrixXd centres(sites_.dimension(), count);
  for (Eigen::Index j = 0; j < count; ++j)
    centres.col(j) = sites_.points.col(candidates[static_cast<std::size_t>(first + j)]);
  const Eigen::Index blocks = (sites_.count() + kRows - 1) / kRows;
  struct Sums {
    Eigen::MatrixXd shares;
    Eigen::VectorXd length_squared;
  };
  std::array<Sums, kParts> sums;
  parallel_for(kParts, [&](int part) {
    Sums& mine = sums[static_cast<std::size_t>(part)];
    mine = {Eigen::MatrixXd::Zero(basis.size() + 1, count), Eigen::VectorXd::Zero(count)};
    Eigen::MatrixXd columns(kRows, count);
    for (Eigen::Index block = blocks * part / kParts; block < blocks * (part + 1) / kParts; ++block) {
      const Eigen::Index row = block * kRows;
      const Eigen::Index rows = std::min(kRows, sites_.count() - row);
      columns.resize(rows, count);
      kernel_matrix(kernel_, points_, centres, columns, row);
      columns.array().colwise() *= sites_.row_scale.segment(row, rows).array();
      mine.length_squared += columns.colwise().squaredNorm().transpose();
      multiply(basis.columns_and_residual().middleRows(row, rows), true, columns, false, 1.0, 1.0, mine.shares);
    }
  });
  for (int part = 1; part < kParts; ++part) {
    sums[0].shares += sums[static_cast<std::size_t>(part)].shares;
    sums[0].length_squared += sums[static_cast<std::size_t>(part)].length_squared;
  }
  out.length_squared.segment(first, count) = sums[0].length_squared;
  out.outside_squared.segment(first, count) =
      sums[0].length_squared - sums[0].shares.topRows(basis.size()).colwise().squaredNorm().transpose();
  out.correlation.segment(first, count) = sums[0].shares.row(basis.size()).transpose();
}

void CandidateGains::recompute(Eigen::Index site, Eigen::Index at, const OrthogonalBasis& basis,
                               CandidateParts& out) const {
  const OrthogonalBasis::Outside part = basis.outside(column(site));
  const bool useful = part.squared > kInsideBasis * out.length_squared[at];
  out.outside_squared[at] = useful ? part.squared : 0.0;
  out.correlation[at] = useful ? part.correlation : 0.0;
}

}  // namespace palpate
