#include "models/correction/orthogonal_basis.h"

#include <algorithm>
#include <cmath>

#include "engine/base/parallel.h"
#include "models/linear/lapack.h"
#include "models/model/kernels.h"

namespace palpate {

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
