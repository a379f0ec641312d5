#include "models/solve/candidate_gains.h"

#include <algorithm>
#include <array>

#include "engine/base/parallel.h"
#include "models/linear/lapack.h"

namespace palpate {
namespace {

// Sites at a time: they share the products with all directions that one of them lacks.
constexpr Eigen::Index kGroup = 4;
// Columns that are orthogonalised at once, 7 MB at 6,850 sites.
constexpr std::size_t kRecompute = 128;
// Each part is summed by itself, then the parts in order: the result does not depend on the number of cores.
constexpr int kParts = 4;

struct Sums {
  Eigen::MatrixXd shares;  // a row per site; the new directions, then the residual
  Eigen::VectorXd length_squared;
};

}  // namespace

CandidateGains::CandidateGains(const Sites& sites, KernelKind kernel)
    : sites_(sites),
      kernel_(kernel),
      points_(sites.points),
      known_to_(static_cast<std::size_t>(sites.count()), 0),
      length_squared_(Eigen::VectorXd::Zero(sites.count())),
      outside_squared_(length_squared_),
      exact_squared_(length_squared_),
      correlation_(length_squared_) {}

Eigen::MatrixXd CandidateGains::columns(std::span<const Eigen::Index> sites) const {
  const auto count = static_cast<Eigen::Index>(sites.size());
  Eigen::MatrixXd centres(sites_.dimension(), count);
  for (Eigen::Index j = 0; j < count; ++j) centres.col(j) = sites_.points.col(sites[static_cast<std::size_t>(j)]);
  Eigen::MatrixXd values(sites_.count(), count);
  kernel_matrix(kernel_, points_, centres, values);
  values.array().colwise() *= sites_.row_scale.array();
  return values;
}

Eigen::VectorXd CandidateGains::column(Eigen::Index site) const { return columns({&site, 1}); }

void CandidateGains::update(std::span<const Eigen::Index> sites, const OrthogonalBasis& basis) {
  std::vector<Eigen::Index> order(sites.begin(), sites.end());
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    const Eigen::Index known_a = known_to_[static_cast<std::size_t>(a)];
    const Eigen::Index known_b = known_to_[static_cast<std::size_t>(b)];
    return known_a != known_b ? known_a < known_b : a < b;
  });
  add_shares(order, basis);
  recompute_cancelled(order, basis);
}

void CandidateGains::add_shares(std::span<const Eigen::Index> sites, const OrthogonalBasis& basis) {
  const auto count = static_cast<Eigen::Index>(sites.size());
  const Eigen::Index groups = (count + kGroup - 1) / kGroup;
  const auto group_size = [&](Eigen::Index group) { return std::min(kGroup, count - group * kGroup); };
  // The sites of a group have at least the directions of its first site.
  const auto known_to = [&](Eigen::Index group) {
    return known_to_[static_cast<std::size_t>(sites[static_cast<std::size_t>(group * kGroup)])];
  };
  std::array<std::vector<Sums>, kParts> sums;
  // A part begins at a multiple of the vector length, to which the points are padded.
  const auto first_row = [&](int part) {
    constexpr auto kVector = static_cast<Eigen::Index>(simd::kSimdPad);
    return std::min(sites_.count(), (sites_.count() * part / kParts + kVector - 1) / kVector * kVector);
  };
  const auto directions = basis.columns_and_residual();
  parallel_for(kParts, [&](int part) {
    std::vector<Sums>& mine = sums[static_cast<std::size_t>(part)];
    for (Eigen::Index group = 0; group < groups; ++group) {
      mine.push_back(
          {Eigen::MatrixXd::Zero(kGroup, basis.size() + 1 - known_to(group)), Eigen::VectorXd::Zero(kGroup)});
    }
    Eigen::MatrixXd centres(sites_.dimension(), kGroup);
    Eigen::MatrixXd memory = Eigen::MatrixXd::Zero(kBlockRows, kGroup);
    const Eigen::Index end = first_row(part + 1);
    for (Eigen::Index row = first_row(part); row < end; row += kBlockRows) {
      const Eigen::Index rows = std::min(kBlockRows, end - row);
      for (Eigen::Index group = 0; group < groups; ++group) {
        const Eigen::Index size = group_size(group);
        for (Eigen::Index j = 0; j < size; ++j)
          centres.col(j) = sites_.points.col(sites[static_cast<std::size_t>(group * kGroup + j)]);
        kernel_matrix(kernel_, points_, centres.leftCols(size), memory.topLeftCorner(rows, size), row);
        Sums& sum = mine[static_cast<std::size_t>(group)];
        auto columns = memory.topLeftCorner(rows, size);
        columns.array().colwise() *= sites_.row_scale.segment(row, rows).array();
        sum.length_squared.head(size) += columns.colwise().squaredNorm().transpose();
        multiply(columns, true, directions.block(row, known_to(group), rows, sum.shares.cols()), false, 1.0, 1.0,
                 sum.shares.topRows(size));
      }
    }
  });
  for (Eigen::Index group = 0; group < groups; ++group) {
    Sums& total = sums[0][static_cast<std::size_t>(group)];
    for (int part = 1; part < kParts; ++part) {
      total.shares += sums[static_cast<std::size_t>(part)][static_cast<std::size_t>(group)].shares;
      total.length_squared += sums[static_cast<std::size_t>(part)][static_cast<std::size_t>(group)].length_squared;
    }
    const Eigen::Index first_known = known_to(group);
    for (Eigen::Index j = 0; j < group_size(group); ++j) {
      const Eigen::Index site = sites[static_cast<std::size_t>(group * kGroup + j)];
      const Eigen::Index known = known_to_[static_cast<std::size_t>(site)];
      if (known == 0) length_squared_[site] = outside_squared_[site] = exact_squared_[site] = total.length_squared[j];
      const Eigen::Index fresh = basis.size() - known;
      outside_squared_[site] -= total.shares.row(j).segment(known - first_known, fresh).squaredNorm();
      correlation_[site] = total.shares(j, total.shares.cols() - 1);
    }
  }
  for (const Eigen::Index site : sites) known_to_[static_cast<std::size_t>(site)] = basis.size();
}

void CandidateGains::advance(std::span<const Eigen::Index> sites, const OrthogonalBasis& basis,
                             const Eigen::VectorXd& along, double residual_share) {
  for (const Eigen::Index site : sites) {
    known_to_[static_cast<std::size_t>(site)] = basis.size();
    outside_squared_[site] -= along[site] * along[site];
    correlation_[site] -= residual_share * along[site];
  }
  recompute_cancelled(sites, basis);
}

void CandidateGains::recompute_cancelled(std::span<const Eigen::Index> sites, const OrthogonalBasis& basis) {
  std::vector<Eigen::Index> cancelled;
  for (const Eigen::Index site : sites)
    if (exact_squared_[site] > 0.0 && outside_squared_[site] <= kCancelled * exact_squared_[site])
      cancelled.push_back(site);
  for (std::size_t first = 0; first < cancelled.size(); first += kRecompute) {
    const std::span<const Eigen::Index> some =
        std::span(cancelled).subspan(first, std::min(kRecompute, cancelled.size() - first));
    Eigen::MatrixXd parts = columns(some);
    basis.project_out(parts);
    for (std::size_t j = 0; j < some.size(); ++j) {
      const auto part = parts.col(static_cast<Eigen::Index>(j));
      correct(some[j], {{}, part.squaredNorm(), part.dot(basis.residual())});
    }
  }
}

void CandidateGains::correct(Eigen::Index site, const OrthogonalBasis::Outside& part) {
  const bool of_use = useful(site, part);
  outside_squared_[site] = exact_squared_[site] = of_use ? part.squared : 0.0;
  correlation_[site] = of_use ? part.correlation : 0.0;
}

}  // namespace palpate
