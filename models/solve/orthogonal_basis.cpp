#include "models/solve/orthogonal_basis.h"

#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "engine/base/parallel.h"
#include "models/model/rbf/polynomial_tail.h"
#include "models/solve/lapack.h"

namespace palpate {
namespace {

// Tail columns nearer than this to the span of the others (a constant feature)
// add nothing but rounding.
constexpr double kDependent = 1e-10;
// Sums over rows are taken per part, then in order: the same for any number of cores.
constexpr int kColumnParts = 4;
// Products of a pass that take about 0.6 ms; starting and joining a thread twice, 0.2 ms.
constexpr Eigen::Index kWorthThreads = 2000000;

}  // namespace

OrthogonalBasis::OrthogonalBasis(const Sites& sites, KernelKind kernel, Eigen::Index more) {
  Eigen::MatrixXd tail = tail_matrix(tail_degree(kernel), sites.points);
  tail.array().colwise() *= sites.row_scale.array();
  memory_.resize(sites.count(), tail.cols() + more + 1);
  memory_.col(0) = sites.target_N.cwiseProduct(sites.row_scale);
  for (Eigen::Index k = 0; k < tail.cols(); ++k) {
    const Outside part = outside(tail.col(k));
    if (part.squared > kDependent * kDependent * tail.col(k).squaredNorm()) add(part);
  }
}

OrthogonalBasis::Outside OrthogonalBasis::outside(const Eigen::VectorXd& column) const {
  Eigen::MatrixXd rest = column;
  project_out(rest);
  return {rest.col(0), rest.squaredNorm(), rest.col(0).dot(residual())};
}

void OrthogonalBasis::project_out(Eigen::MatrixXd& columns) const {
  const auto rows_of = [&](int part) {
    const Eigen::Index first = memory_.rows() * part / kColumnParts;
    return std::pair{first, memory_.rows() * (part + 1) / kColumnParts - first};
  };
  // Work that is done sooner than threads are started stays on this one.
  const bool small = memory_.rows() * size_ * columns.cols() < kWorthThreads;
  const auto for_parts = [&](const std::function<void(int)>& work) {
    if (!small) return parallel_for(kColumnParts, work);
    for (int part = 0; part < kColumnParts; ++part) work(part);
  };
  std::array<Eigen::MatrixXd, kColumnParts> shares;
  const auto share = [&](int part) {
    const auto [first, rows] = rows_of(part);
    Eigen::MatrixXd& mine = shares[static_cast<std::size_t>(part)];
    mine.resize(size_, columns.cols());
    multiply(memory_.block(first, 0, rows, size_), true, columns.middleRows(first, rows), false, 1.0, 0.0, mine);
  };
  Eigen::MatrixXd sum;
  const auto add_up = [&] {
    sum = shares[0];
    for (int part = 1; part < kColumnParts; ++part) sum += shares[static_cast<std::size_t>(part)];
  };
  const auto subtract = [&](int part) {
    const auto [first, rows] = rows_of(part);
    multiply(memory_.block(first, 0, rows, size_), false, sum, false, -1.0, 1.0, columns.middleRows(first, rows));
  };
  for_parts(share);
  add_up();
  // While the rows of a part are in the cache, its shares of the second pass.
  for_parts([&](int part) {
    subtract(part);
    share(part);
  });
  add_up();
  for_parts(subtract);
}

Eigen::VectorXd OrthogonalBasis::add(const Outside& part) {
  const Eigen::VectorXd q = part.column / std::sqrt(part.squared);
  const Eigen::VectorXd left = residual() - q.dot(residual()) * q;
  memory_.col(size_) = q;
  ++size_;
  memory_.col(size_) = left;
  return q;
}

}  // namespace palpate
