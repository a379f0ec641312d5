// The kD-tree method. The sites are split into two leaves, whose barycentres are the centres. Then, in each step, the
// function is fitted, the sample with the largest error over the JND is found, and its leaf is split at the median of
// its widest dimension, which replaces one centre by two. From 100 leaves on a step also splits those with the next
// largest errors, one for each hundred leaves, so that the time grows with the number of centres and not its square.
//
// A refit costs one new pair of columns, not a new matrix: the polynomial tail is projected out of the columns, and
// their Gram matrix is updated and factorised (Cholesky, with a relative ridge of 1e-13). Duplicate sites stay in one
// leaf. A leaf with a single point cannot be split; the sample with the next largest error is taken. O(N centres) a
// step. A tree depends on rounding, which decides between equal coordinates and errors: seeds above 1 draw the 12th
// digit of all coordinates, to show how much. Source: Hoever & Harders (2009), section 4.2.2.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <utility>
#include <vector>

#include "engine/base/parallel.h"
#include "models/correction/algebra.h"
#include "models/correction/methods.h"
#include "models/linear/lapack.h"
#include "models/model/correction.h"

namespace palpate {
namespace {

using Leaf = std::vector<Eigen::Index>;  // sites
// Up to the default number of centres one leaf is split between two fits, as in the paper.
constexpr std::size_t kLeavesOfASplit = 100;

Eigen::VectorXd barycentre(const Eigen::MatrixXd& points, const Leaf& leaf) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(points.rows());
  for (const Eigen::Index site : leaf) sum += points.col(site);
  return sum / static_cast<double>(leaf.size());
}

// Splits a leaf in its widest dimension, at the boundary between different coordinates nearest to the median. Returns
// the upper part; empty, without a change, if all points are equal.
Leaf split(const Eigen::MatrixXd& points, Leaf& leaf) {
  Eigen::VectorXd low = points.col(leaf.front());
  Eigen::VectorXd high = low;
  for (const Eigen::Index site : leaf) {
    low = low.cwiseMin(points.col(site));
    high = high.cwiseMax(points.col(site));
  }
  Eigen::Index widest = 0;
  if (!((high - low).maxCoeff(&widest) > 0.0)) return {};
  const auto value = [&](Eigen::Index site) { return std::pair(points(widest, site), site); };
  std::sort(leaf.begin(), leaf.end(), [&](Eigen::Index a, Eigen::Index b) { return value(a) < value(b); });
  const auto size = static_cast<std::ptrdiff_t>(leaf.size());
  const auto begin = leaf.begin();
  std::ptrdiff_t boundary = 0;
  for (std::ptrdiff_t i = 1; i < size; ++i) {
    if (!(points(widest, begin[i - 1]) < points(widest, begin[i]))) continue;
    if (boundary == 0 || std::abs(i - size / 2) < std::abs(boundary - size / 2)) boundary = i;
  }
  Leaf upper(begin + boundary, leaf.end());
  leaf.erase(begin + boundary, leaf.end());
  return upper;
}

// The least squares problem of the growing tree: columns with the tail
// projected out, and their Gram matrix.
class GrowingFit {
 public:
  GrowingFit(const Sites& sites, Eigen::Index most) : sites_(sites), points_(sites.points), tail_(sites, 0) {
    columns_.resize(sites.count(), most);
    gram_.resize(most, most);
    right_.resize(most);
  }

  // Sets the columns `at` to those of `centres` (d x k). A column is below size(), or the next ones.
  void set(const Eigen::MatrixXd& centres, const std::vector<Eigen::Index>& at) {
    size_ = std::max(size_, at.back() + 1);
    Eigen::MatrixXd fresh(sites_.count(), centres.cols());
    kernel_matrix(sites_.kernel, points_, centres, fresh);
    fresh.array().colwise() *= sites_.row_scale.array();
    tail_.project_out(fresh);
    columns_(Eigen::all, at) = fresh;
    right_(at) = fresh.transpose() * tail_.residual();
    std::array<Eigen::MatrixXd, kParts> products;
    parallel_for(kParts, [&](int part) {
      Eigen::MatrixXd& product = products[static_cast<std::size_t>(part)];
      product = Eigen::MatrixXd::Zero(size_, fresh.cols());
      // By blocks of rows, which stay in the cache for the next column.
      const Eigen::Index end = first_row(part + 1);
      for (Eigen::Index row = first_row(part); row < end; row += kBlockRows) {
        const Eigen::Index some = std::min(kBlockRows, end - row);
        multiply(columns_.block(row, 0, some, size_), true, fresh.middleRows(row, some), false, 1.0, 1.0, product);
      }
    });
    const Eigen::MatrixXd product = products[0] + products[1];
    for (std::size_t k = 0; k < at.size(); ++k) {
      gram_.col(at[k]).head(size_) = product.col(static_cast<Eigen::Index>(k));
      gram_.row(at[k]).head(size_) = gram_.col(at[k]).head(size_).transpose();
    }
  }

  // row_scale (f - h) at every site for the best weights.
  Eigen::VectorXd residual() const {
    const Eigen::VectorXd weights = solve_with_ridge(gram_.topLeftCorner(size_, size_), right_.head(size_), 1e-13);
    Eigen::VectorXd rest = tail_.residual();
    parallel_for(kParts, [&](int part) {
      const Eigen::Index rows = first_row(part + 1) - first_row(part);
      multiply(columns_.block(first_row(part), 0, rows, size_), false, weights, false, -1.0, 1.0,
               rest.segment(first_row(part), rows));
    });
    return rest;
  }

 private:
  // Each of two threads takes half of the rows. The number is fixed, so that the sums do not depend on the number of
  // cores.
  static constexpr int kParts = 2;
  Eigen::Index first_row(int part) const { return sites_.count() * part / kParts; }

  const Sites& sites_;
  PointArrays points_;
  OrthogonalBasis tail_;
  Eigen::MatrixXd columns_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd right_;
  Eigen::Index size_ = 0;
};

Result<FittedCorrection> fit_kdtree(const MethodTask& task, const FitControl& control) {
  Sites sites = task.sites;
  SplitMix64 random(task.seed);
  if (task.seed > 1)
    for (double& x : sites.points.reshaped()) x *= 1.0 + 1e-15 * static_cast<double>(random.below(1000));
  const auto most = static_cast<std::size_t>(std::min<Eigen::Index>(std::max(task.centres, 0), sites.count()));
  const BlasThreads one_thread(1);
  std::vector<Leaf> leaves;
  std::vector<std::size_t> leaf_of(static_cast<std::size_t>(sites.count()), 0);
  Eigen::MatrixXd centres(sites.dimension(), static_cast<Eigen::Index>(most));
  GrowingFit fit(sites, centres.cols());
  const auto set = [&](const std::vector<std::size_t>& changed) {
    std::vector<Eigen::Index> at;
    for (const std::size_t leaf : changed) {
      at.push_back(static_cast<Eigen::Index>(leaf));
      centres.col(at.back()) = barycentre(sites.points, leaves[leaf]);
    }
    fit.set(centres(Eigen::all, at), at);
  };
  if (most > 0) {
    leaves.emplace_back(leaf_of.size());
    std::iota(leaves[0].begin(), leaves[0].end(), Eigen::Index{0});
    set({0});
  }
  while (leaves.size() < most) {
    if (!control.may_continue(0.95 * static_cast<double>(leaves.size()) / static_cast<double>(most)))
      return interrupted();
    // Errors in JND; 0 for sites without weight, so that the leaves of others are split first.
    const Eigen::ArrayXd error = fit.residual().array().abs();
    Eigen::ArrayXd excess =
        (sites.row_scale.array() > 0.0).select(error / (sites.row_scale.array() * task.jnd_N.array()), 0.0);
    std::vector<std::size_t> changed;
    for (std::size_t splits = 1 + leaves.size() / kLeavesOfASplit; splits > 0 && leaves.size() < most; --splits) {
      Leaf upper;
      Eigen::Index worst = 0;
      std::size_t lower = 0;
      while (upper.empty() && excess.maxCoeff(&worst) >= 0.0) {
        lower = leaf_of[static_cast<std::size_t>(worst)];
        excess(leaves[lower]).setConstant(-1.0);
        upper = split(sites.points, leaves[lower]);
      }
      if (upper.empty()) break;
      for (const Eigen::Index site : upper) leaf_of[static_cast<std::size_t>(site)] = leaves.size();
      changed.insert(changed.end(), {lower, leaves.size()});
      leaves.push_back(std::move(upper));
    }
    if (changed.empty()) break;
    set(changed);
  }
  return fit_centres(task, centres.leftCols(static_cast<Eigen::Index>(leaves.size())), "no leaf can be split further");
}

}  // namespace

const Method kKdTreeMethod{
    .name = "kdtree",
    .colour = 0x0072B2,
    .takes = kTakesCentres | kTakesKernel | kTakesSeed,
    .expected_seconds = 0.11,
    .fit = fit_kdtree,
};

}  // namespace palpate
