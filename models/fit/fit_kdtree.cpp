// The kD-tree method. The sites are split into two leaves, whose barycentres are the centres. Then, in each step, the
// function is fitted, the sample with the largest error over the JND is found, and its leaf is split at the median of
// its widest dimension, which replaces one centre by two.
//
// A refit costs one new pair of columns, not a new matrix: the polynomial tail is projected out of the columns, and
// their Gram matrix is updated and factorised (Cholesky, with a relative ridge of 1e-13). Duplicate sites stay in one
// leaf. A leaf with a single point cannot be split; the sample with the next largest error is taken. O(N centres) a
// step.
// Source: Hoever & Harders (2009), section 4.2.2.
#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

#include "engine/base/parallel.h"
#include "models/fit/methods.h"
#include "models/linear/lapack.h"
#include "models/model/rbf/rbf_evaluate.h"
#include "models/solve/orthogonal_basis.h"

namespace palpate {
namespace {

// The leaves of a kD-tree over sites: disjoint sets, each of which can be split at the median of its widest dimension.
class SiteTree {
 public:
  // One leaf with all points. `points`: d x N, N >= 1; must outlive this.
  explicit SiteTree(const Eigen::MatrixXd& points)
      : points_(points),
        order_(static_cast<std::size_t>(points.cols())),
        leaves_{{0, static_cast<std::size_t>(points.cols())}},
        leaf_of_(static_cast<std::size_t>(points.cols()), 0) {
    std::iota(order_.begin(), order_.end(), Eigen::Index{0});
  }

  Eigen::Index leaf_count() const { return static_cast<Eigen::Index>(leaves_.size()); }
  Eigen::Index leaf_of(Eigen::Index site) const { return leaf_of_[static_cast<std::size_t>(site)]; }

  Eigen::VectorXd barycentre(Eigen::Index leaf) const {
    const Leaf& range = leaves_[static_cast<std::size_t>(leaf)];
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(points_.rows());
    for (std::size_t i = range.begin; i < range.end; ++i) sum += points_.col(order_[i]);
    return sum / static_cast<double>(range.end - range.begin);
  }

  // Splits a leaf at the boundary between different coordinates nearest to the median. The lower part keeps the index,
  // the upper one gets leaf_count(). Returns false, without a change, if all points of the leaf are equal.
  bool split(Eigen::Index leaf) {
    const Leaf range = leaves_[static_cast<std::size_t>(leaf)];
    Eigen::VectorXd low = points_.col(order_[range.begin]);
    Eigen::VectorXd high = low;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      low = low.cwiseMin(points_.col(order_[i]));
      high = high.cwiseMax(points_.col(order_[i]));
    }
    Eigen::Index widest = 0;
    if (!((high - low).maxCoeff(&widest) > 0.0)) return false;
    const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(range.begin);
    const auto end = order_.begin() + static_cast<std::ptrdiff_t>(range.end);
    const auto value = [&](Eigen::Index site) { return points_(widest, site); };
    std::sort(begin, end,
              [&](Eigen::Index a, Eigen::Index b) { return value(a) != value(b) ? value(a) < value(b) : a < b; });
    // Splits between different values, as near to the middle as possible.
    const auto middle = begin + (end - begin) / 2;
    const double median = value(*middle);
    const auto first_equal = std::partition_point(begin, end, [&](Eigen::Index s) { return value(s) < median; });
    const auto first_above = std::partition_point(begin, end, [&](Eigen::Index s) { return value(s) <= median; });
    const bool lower_is_nearer = middle - first_equal <= first_above - middle;
    auto boundary = lower_is_nearer ? first_equal : first_above;
    if (boundary == begin) boundary = first_above;
    if (boundary == end) boundary = first_equal;
    const auto at = static_cast<std::size_t>(boundary - order_.begin());
    leaves_[static_cast<std::size_t>(leaf)].end = at;
    for (std::size_t i = at; i < range.end; ++i) leaf_of_[static_cast<std::size_t>(order_[i])] = leaf_count();
    leaves_.push_back({at, range.end});
    return true;
  }

 private:
  struct Leaf {
    std::size_t begin = 0;
    std::size_t end = 0;
  };
  const Eigen::MatrixXd& points_;
  std::vector<Eigen::Index> order_;  // sites, leaf by leaf
  std::vector<Leaf> leaves_;
  std::vector<Eigen::Index> leaf_of_;
};

// The least squares problem of the growing tree: columns with the tail
// projected out, and their Gram matrix.
class GrowingFit {
 public:
  GrowingFit(const Sites& sites, KernelKind kernel, Eigen::Index most)
      : sites_(sites), kernel_(kernel), points_(sites.points), tail_(sites, kernel, 0) {
    columns_.resize(sites.count(), most);
    gram_.resize(most, most);
    right_.resize(most);
  }

  // Sets the columns `at` to those of `centres` (d x k). A column is below size(), or the next ones.
  void set(const Eigen::MatrixXd& centres, const std::vector<Eigen::Index>& at) {
    const Eigen::Index count = centres.cols();
    for (const Eigen::Index index : at) size_ = std::max(size_, index + 1);
    Eigen::MatrixXd fresh(sites_.count(), count);
    std::array<Eigen::MatrixXd, kParts> shares;
    parallel_for(kParts, [&](int part) {
      const auto [first, rows] = rows_of(part);
      auto mine = fresh.middleRows(first, rows);
      kernel_matrix(kernel_, points_, centres, mine, first);
      mine.array().colwise() *= sites_.row_scale.segment(first, rows).array();
      Eigen::MatrixXd& share = shares[static_cast<std::size_t>(part)];
      share.resize(tail_.size(), count);
      multiply(tail_.columns().middleRows(first, rows), true, mine, false, 1.0, 0.0, share);
    });
    const Eigen::MatrixXd tail_shares = shares[0] + shares[1];
    std::array<Eigen::MatrixXd, kParts> products;
    std::array<Eigen::VectorXd, kParts> right;
    parallel_for(kParts, [&](int part) {
      const auto [first, rows] = rows_of(part);
      auto mine = fresh.middleRows(first, rows);
      multiply(tail_.columns().middleRows(first, rows), false, tail_shares, false, -1.0, 1.0, mine);
      for (std::size_t k = 0; k < at.size(); ++k)
        columns_.col(at[k]).segment(first, rows) = mine.col(static_cast<Eigen::Index>(k));
      Eigen::MatrixXd& product = products[static_cast<std::size_t>(part)];
      product.resize(size_, count);
      product.setZero();
      // One column at a time, because dgemm would spend its time copying; by blocks of rows, which stay in the cache
      // for the next column.
      for (Eigen::Index row = 0; row < rows; row += kBlockRows) {
        const Eigen::Index some = std::min(kBlockRows, rows - row);
        for (Eigen::Index k = 0; k < count; ++k)
          multiply(columns_.block(first + row, 0, some, size_), true, mine.block(row, k, some, 1), false, 1.0, 1.0,
                   product.col(k));
      }
      right[static_cast<std::size_t>(part)] = mine.transpose() * tail_.residual().segment(first, rows);
    });
    for (std::size_t k = 0; k < at.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      gram_.col(at[k]).head(size_) = products[0].col(column) + products[1].col(column);
      gram_.row(at[k]).head(size_) = gram_.col(at[k]).head(size_).transpose();
      right_[at[k]] = right[0][column] + right[1][column];
    }
  }

  // row_scale (f - h) at every site for the best weights.
  Eigen::VectorXd residual() const {
    const Eigen::VectorXd weights = solve_with_ridge(gram_.topLeftCorner(size_, size_), right_.head(size_), 1e-13);
    Eigen::VectorXd rest = tail_.residual();
    parallel_for(kParts, [&](int part) {
      const auto [first, rows] = rows_of(part);
      multiply(columns_.block(first, 0, rows, size_), false, weights, false, -1.0, 1.0, rest.segment(first, rows));
    });
    return rest;
  }

 private:
  // Each of two threads takes half of the rows. The number is fixed, so that the sums do not depend on the number of
  // cores; the first half is a multiple of 8, as kernel_matrix requires.
  static constexpr int kParts = 2;
  std::pair<Eigen::Index, Eigen::Index> rows_of(int part) const {
    const Eigen::Index half = sites_.count() / 16 * 8;
    return part == 0 ? std::pair{Eigen::Index{0}, half} : std::pair{half, sites_.count() - half};
  }

  const Sites& sites_;
  KernelKind kernel_;
  PointArrays points_;
  OrthogonalBasis tail_;
  Eigen::MatrixXd columns_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd right_;
  Eigen::Index size_ = 0;
};

// Splits the leaf of the site with the largest error, among the leaves that can be split; returns its number, or -1.
Eigen::Index split_worst(SiteTree& tree, const Eigen::VectorXd& excess, std::vector<bool>& whole) {
  whole.resize(static_cast<std::size_t>(tree.leaf_count()), true);
  while (true) {
    Eigen::Index worst = -1;
    for (Eigen::Index i = 0; i < excess.size(); ++i)
      if (whole[static_cast<std::size_t>(tree.leaf_of(i))] && (worst < 0 || excess[i] > excess[worst])) worst = i;
    if (worst < 0) return -1;
    const Eigen::Index leaf = tree.leaf_of(worst);
    if (tree.split(leaf)) return leaf;
    whole[static_cast<std::size_t>(leaf)] = false;
  }
}

// Errors in JND; 0 for sites without weight, so that the leaves of others are split first.
Eigen::VectorXd excess_of(const GrowingFit& fit, const Sites& sites, const Eigen::VectorXd& jnd_N) {
  const Eigen::VectorXd residual = fit.residual();
  return (sites.row_scale.array() > 0.0)
      .select(residual.array().abs() / (sites.row_scale.array() * jnd_N.array()), 0.0);
}

Result<CentreSequence> choose_kdtree(const MethodTask& task, const FitControl& control) {
  const Sites& sites = task.sites;
  const MethodRequest& request = task.request;
  CentreSequence sequence{Eigen::MatrixXd(sites.dimension(), 0), {}, 2, ""};
  if (request.centres <= 0) return sequence;
  const BlasThreads one_thread(1);
  SiteTree tree(sites.points);
  const Eigen::Index most = std::min<Eigen::Index>(request.centres, sites.count());
  GrowingFit fit(sites, request.kernel, most);
  sequence.pool.resize(sites.dimension(), 2 * most - 1);
  const auto add = [&](Eigen::Index leaf) {
    sequence.pool.col(static_cast<Eigen::Index>(sequence.places.size())) = tree.barycentre(leaf);
    sequence.places.push_back(leaf);
  };
  add(0);
  fit.set(sequence.pool.leftCols(1), {0});
  std::vector<bool> whole;
  while (tree.leaf_count() < most) {
    if (!control.may_continue(0.95 * static_cast<double>(tree.leaf_count()) / static_cast<double>(most)))
      return interrupted();
    // The first split does not depend on errors: there is one leaf.
    const Eigen::Index lower = split_worst(tree, excess_of(fit, sites, task.jnd_N), whole);
    if (lower < 0) break;
    const Eigen::Index upper = tree.leaf_count() - 1;
    const auto before = static_cast<Eigen::Index>(sequence.places.size());
    add(lower);
    add(upper);
    fit.set(sequence.pool.middleCols(before, 2), {lower, upper});
  }
  sequence.pool.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(sequence.places.size()));
  if (sequence.most() < request.centres) sequence.shortage = "no leaf can be split further";
  return sequence;
}

}  // namespace

const Method kKdTreeMethod{
    .name = "kdtree",
    .label = "kD-tree",
    .colour = 0x0072B2,
    .takes = kTakesCentres | kTakesKernel,
    .expected_seconds =
        [](const MethodRequest& request) {
          const double hundreds = 0.01 * request.centres;
          return 0.1 + 0.01 * hundreds * hundreds * hundreds;
        },
    .choose = choose_kdtree,
};

}  // namespace palpate
