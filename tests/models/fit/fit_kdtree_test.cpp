#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <utility>
#include <vector>

#include "models/solve/site_tree.h"
#include "tests/support/fit_centres.h"
#include "tests/support/plain_rbf.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

using test::fit_kdtree;
using test::smooth_sites;

Eigen::VectorXd jnd_of(const Sites& sites) { return (0.065 + 0.0633 * sites.target_N.array().abs()).matrix(); }

RbfFunction least_squares(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres) {
  const Eigen::MatrixXd tail = tail_matrix(tail_degree(kernel), sites.points);
  Eigen::MatrixXd matrix(sites.count(), centres.cols() + tail.cols());
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < centres.cols(); ++j)
      matrix(i, j) = kernel_value(kernel, (sites.points.col(i) - centres.col(j)).norm());
  matrix.rightCols(tail.cols()) = tail;
  matrix.array().colwise() *= sites.row_scale.array();
  const Eigen::VectorXd data = sites.target_N.cwiseProduct(sites.row_scale);
  const Eigen::VectorXd solution = matrix.colPivHouseholderQr().solve(data);
  return {kernel, centres, solution.head(centres.cols()), solution.tail(tail.cols())};
}

// Section 4.2.2 literally: a full least squares fit after every split.
Eigen::MatrixXd plain_centres(const Sites& sites, const Eigen::VectorXd& jnd_N, KernelKind kernel, int count) {
  SiteTree tree(sites.points);
  tree.split(0);
  while (true) {
    Eigen::MatrixXd centres(sites.dimension(), tree.leaf_count());
    for (Eigen::Index k = 0; k < tree.leaf_count(); ++k) centres.col(k) = tree.barycentre(k);
    if (tree.leaf_count() == count) return centres;
    const RbfFunction function = least_squares(sites, kernel, centres);
    std::vector<std::pair<double, Eigen::Index>> worst_first;
    for (Eigen::Index i = 0; i < sites.count(); ++i) {
      const double error = std::abs(rbf_value(function, sites.points.col(i).data()) - sites.target_N[i]);
      worst_first.emplace_back(-error / jnd_N[i], i);
    }
    std::sort(worst_first.begin(), worst_first.end());
    for (const auto& [excess, site] : worst_first)
      if (tree.split(tree.leaf_of(site))) break;
  }
}

TEST(FitKdTree, EqualsAFullRefitAfterEverySplit) {
  const Sites sites = smooth_sites(3, 500, 0.05, 1);
  const Eigen::VectorXd jnd_N = jnd_of(sites);
  for (const KernelKind kernel : kKernelKinds) {
    const auto fitted = fit_kdtree(sites, jnd_N, {.centres = 25, .kernel = kernel});
    ASSERT_TRUE(fitted.ok());
    EXPECT_EQ(fitted->function.centres, plain_centres(sites, jnd_N, kernel, 25)) << kernel_name(kernel);
  }
}

}  // namespace
}  // namespace palpate
