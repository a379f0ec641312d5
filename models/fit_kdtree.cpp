#include "models/fit_kdtree.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "models/candidate_gains.h"
#include "models/lapack.h"
#include "models/orthogonal_basis.h"
#include "models/site_tree.h"
#include "models/solve_weights.h"

namespace palpate {
namespace {

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

  // Puts columns for `centres` (d x k) at the places `at`, which are below
  // size() or next to it.
  void set(const Eigen::MatrixXd& centres, const std::vector<Eigen::Index>& at) {
    Eigen::MatrixXd fresh(sites_.count(), centres.cols());
    kernel_matrix(kernel_, points_, centres, fresh);
    fresh.array().colwise() *= sites_.row_scale.array();
    Eigen::MatrixXd shares(tail_.size(), centres.cols());
    multiply(tail_.columns(), true, fresh, false, 1.0, 0.0, shares);
    multiply(tail_.columns(), false, shares, false, -1.0, 1.0, fresh);
    for (std::size_t k = 0; k < at.size(); ++k) {
      columns_.col(at[k]) = fresh.col(static_cast<Eigen::Index>(k));
      size_ = std::max(size_, at[k] + 1);
    }
    Eigen::MatrixXd products(size_, centres.cols());
    multiply(columns_.leftCols(size_), true, fresh, false, 1.0, 0.0, products);
    for (std::size_t k = 0; k < at.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      gram_.col(at[k]).head(size_) = products.col(column);
      gram_.row(at[k]).head(size_) = products.col(column).transpose();
      right_[at[k]] = fresh.col(column).dot(tail_.residual());
    }
  }

  // row_scale (f - h) at every site for the best weights.
  Eigen::VectorXd residual() const {
    // Columns scaled to length 1; those that are nothing keep the weight 0.
    Eigen::VectorXd scale = gram_.diagonal().head(size_).cwiseSqrt();
    const double tiny = 1e-20 * scale.maxCoeff();
    scale = (scale.array() > tiny).select(scale.cwiseInverse(), 0.0);
    const Eigen::MatrixXd scaled = scale.asDiagonal() * gram_.topLeftCorner(size_, size_) * scale.asDiagonal();
    Eigen::VectorXd weights;
    for (double ridge = 1e-13; ridge < 1.0; ridge *= 100.0) {
      Eigen::MatrixXd factor = scaled;
      factor.diagonal().array() += ridge;
      if (!cholesky_in_place(factor)) continue;
      weights = scale.cwiseProduct(right_.head(size_));
      cholesky_solve(factor, weights);
      break;
    }
    Eigen::MatrixXd rest = tail_.residual();
    const Eigen::MatrixXd scaled_weights = weights.cwiseProduct(scale);
    multiply(columns_.leftCols(size_), false, scaled_weights, false, -1.0, 1.0, rest);
    return rest.col(0);
  }

 private:
  const Sites& sites_;
  KernelKind kernel_;
  PointArrays points_;
  OrthogonalBasis tail_;
  Eigen::MatrixXd columns_;
  Eigen::MatrixXd gram_;
  Eigen::VectorXd right_;
  Eigen::Index size_ = 0;
};

// Splits the leaf of the worst sample that can be split; its number, or -1.
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

// Errors over the JND. A site that counts for nothing never asks for a split
// before the others.
Eigen::VectorXd excess_of(const GrowingFit& fit, const Sites& sites, const Eigen::VectorXd& jnd_N) {
  const Eigen::VectorXd residual = fit.residual();
  return (sites.row_scale.array() > 0.0)
      .select(residual.array().abs() / (sites.row_scale.array() * jnd_N.array()), 0.0);
}

}  // namespace

Result<FittedRbf> fit_kdtree(const Sites& sites, const Eigen::VectorXd& jnd_N, const KdTreeOptions& options,
                             const FitControl& control) {
  if (const Status status = validate_sites(sites); !status) return status.error();
  if (jnd_N.size() != sites.count() || !jnd_N.allFinite() || !(jnd_N.minCoeff() > 0.0))
    return Error{"jnd_N has " + std::to_string(jnd_N.size()) + " entries or one that is not positive, expected " +
                 std::to_string(sites.count()) + " thresholds above 0 N"};
  const BlasThreads one_thread(1);
  SiteTree tree(sites.points);
  const Eigen::Index most = std::max<Eigen::Index>(1, std::min(options.centres, sites.count()));
  GrowingFit fit(sites, options.kernel, most);
  Eigen::MatrixXd centres(sites.dimension(), most);
  centres.col(0) = tree.barycentre(0);
  fit.set(centres.leftCols(1), {0});
  std::vector<bool> whole;
  while (tree.leaf_count() < most) {
    if (!control.go_on(0.95 * static_cast<double>(tree.leaf_count()) / static_cast<double>(most)))
      return interrupted();
    // The first split does not depend on errors: there is one leaf.
    const Eigen::Index lower = split_worst(tree, excess_of(fit, sites, jnd_N), whole);
    if (lower < 0) break;
    const Eigen::Index upper = tree.leaf_count() - 1;
    centres.col(lower) = tree.barycentre(lower);
    centres.col(upper) = tree.barycentre(upper);
    Eigen::MatrixXd pair(sites.dimension(), 2);
    pair << centres.col(lower), centres.col(upper);
    fit.set(pair, {lower, upper});
  }
  const Eigen::Index used = options.centres > 0 ? tree.leaf_count() : 0;
  Result<FittedRbf> fitted = solve_weights(sites, options.kernel, centres.leftCols(used), {}, Ridge::by_evidence);
  if (!fitted) return fitted;
  fitted->report.centres_asked = options.centres;
  if (used < options.centres)
    fitted->report.notes.push_back("only " + std::to_string(used) + " centres: no leaf can be split further");
  if (!control.go_on(1.0)) return interrupted();
  return fitted;
}

}  // namespace palpate
