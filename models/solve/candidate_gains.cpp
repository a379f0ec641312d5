#include "models/solve/candidate_gains.h"

#include <algorithm>
#include <array>

#include "models/solve/lapack.h"
#include "engine/base/parallel.h"

namespace palpate {
namespace {

// Sites at a time: they share one product with the directions that the furthest
// behind of them lacks, so few; fewer still leave the product slow.
constexpr Eigen::Index kBatch = 32;
// Rows at a time: a block of columns stays in the second-level cache between
// its computation and its use.
constexpr Eigen::Index kRows = 512;
// Columns whose part outside is computed at once, 7 MB at 6,850 sites.
constexpr std::size_t kRecompute = 128;
// Sums are taken per part, then in order: the same for any number of cores.
constexpr int kParts = 4;

struct Sums {
  Eigen::MatrixXd shares;  // of the new directions; the last row: of the residual
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
  const Eigen::Index batches = (count + kBatch - 1) / kBatch;
  const auto batch_size = [&](Eigen::Index batch) { return std::min(kBatch, count - batch * kBatch); };
  // The directions known to the first of a batch are known to all of it.
  const auto known_to = [&](Eigen::Index at) {
    return known_to_[static_cast<std::size_t>(sites[static_cast<std::size_t>(at)])];
  };
  std::array<std::vector<Sums>, kParts> sums;
  const Eigen::Index blocks = (sites_.count() + kRows - 1) / kRows;
  parallel_for(kParts, [&](int part) {
    std::vector<Sums>& mine = sums[static_cast<std::size_t>(part)];
    for (Eigen::Index batch = 0; batch < batches; ++batch)
      mine.push_back({Eigen::MatrixXd::Zero(basis.size() + 1 - known_to(batch * kBatch), batch_size(batch)),
                      Eigen::VectorXd::Zero(batch_size(batch))});
    Eigen::MatrixXd centres(sites_.dimension(), kBatch);
    Eigen::MatrixXd memory(kRows, kBatch);
    for (Eigen::Index block = blocks * part / kParts; block < blocks * (part + 1) / kParts; ++block) {
      const Eigen::Index row = block * kRows;
      const Eigen::Index rows = std::min(kRows, sites_.count() - row);
      for (Eigen::Index batch = 0; batch < batches; ++batch) {
        const Eigen::Index size = batch_size(batch);
        for (Eigen::Index j = 0; j < size; ++j)
          centres.col(j) = sites_.points.col(sites[static_cast<std::size_t>(batch * kBatch + j)]);
        auto columns = memory.topLeftCorner(rows, size);
        kernel_matrix(kernel_, points_, centres.leftCols(size), columns, row);
        columns.array().colwise() *= sites_.row_scale.segment(row, rows).array();
        Sums& sum = mine[static_cast<std::size_t>(batch)];
        // The lengths of what has been looked at before are known.
        if (known_to(batch * kBatch) == 0) sum.length_squared += columns.colwise().squaredNorm().transpose();
        multiply(basis.columns_and_residual().block(row, known_to(batch * kBatch), rows, sum.shares.rows()), true,
                 columns, false, 1.0, 1.0, sum.shares);
      }
    }
  });
  for (Eigen::Index batch = 0; batch < batches; ++batch) {
    Sums& total = sums[0][static_cast<std::size_t>(batch)];
    for (int part = 1; part < kParts; ++part) {
      total.shares += sums[static_cast<std::size_t>(part)][static_cast<std::size_t>(batch)].shares;
      total.length_squared += sums[static_cast<std::size_t>(part)][static_cast<std::size_t>(batch)].length_squared;
    }
    const Eigen::Index first_known = known_to(batch * kBatch);
    for (Eigen::Index j = 0; j < batch_size(batch); ++j) {
      const Eigen::Index site = sites[static_cast<std::size_t>(batch * kBatch + j)];
      Eigen::Index& known = known_to_[static_cast<std::size_t>(site)];
      if (known == 0)
        length_squared_[site] = outside_squared_[site] = exact_squared_[site] = total.length_squared[j];
      const Eigen::Index fresh = basis.size() - known;
      outside_squared_[site] -= total.shares.col(j).segment(known - first_known, fresh).squaredNorm();
      correlation_[site] = total.shares(total.shares.rows() - 1, j);
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
