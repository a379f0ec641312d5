#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

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

using Leaf = std::vector<Eigen::Index>;

// Splits a leaf in its widest dimension, between two different values, as near to the median as possible.
bool split(std::vector<Leaf>& leaves, std::size_t at, const Eigen::MatrixXd& points) {
  Leaf& leaf = leaves[at];
  if (leaf.size() < 2) return false;
  const Eigen::MatrixXd mine = points(Eigen::all, leaf);
  Eigen::Index widest = 0;
  (mine.rowwise().maxCoeff() - mine.rowwise().minCoeff()).maxCoeff(&widest);
  std::sort(leaf.begin(), leaf.end(), [&](Eigen::Index a, Eigen::Index b) {
    return std::pair(points(widest, a), a) < std::pair(points(widest, b), b);
  });
  const auto from_median = [&](std::size_t i) {
    return std::abs(static_cast<double>(i) - static_cast<double>(leaf.size() / 2));
  };
  std::size_t cut = 0;
  for (std::size_t i = 1; i < leaf.size(); ++i) {
    const bool differs = points(widest, leaf[i - 1]) < points(widest, leaf[i]);
    if (differs && (cut == 0 || from_median(i) < from_median(cut))) cut = i;
  }
  if (cut == 0) return false;
  Leaf upper(leaf.begin() + static_cast<std::ptrdiff_t>(cut), leaf.end());
  leaf.resize(cut);
  leaves.push_back(std::move(upper));
  return true;
}

Eigen::VectorXd barycentre(const Leaf& leaf, const Eigen::MatrixXd& points) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(points.rows());
  for (const Eigen::Index site : leaf) sum += points.col(site);
  return sum / static_cast<double>(leaf.size());
}

// Section 4.2.2 literally: a full least squares fit after every split.
Eigen::MatrixXd plain_centres(const Sites& sites, const Eigen::VectorXd& jnd_N, KernelKind kernel, std::size_t count) {
  std::vector<Leaf> leaves(1, Leaf(static_cast<std::size_t>(sites.count())));
  std::iota(leaves[0].begin(), leaves[0].end(), Eigen::Index{0});
  split(leaves, 0, sites.points);
  while (true) {
    Eigen::MatrixXd centres(sites.dimension(), static_cast<Eigen::Index>(leaves.size()));
    for (Eigen::Index k = 0; k < centres.cols(); ++k)
      centres.col(k) = barycentre(leaves[static_cast<std::size_t>(k)], sites.points);
    if (leaves.size() == count) return centres;
    const RbfFunction function = least_squares(sites, kernel, centres);
    std::vector<std::pair<double, std::size_t>> worst_first;  // of the leaf of each site
    for (std::size_t k = 0; k < leaves.size(); ++k) {
      for (const Eigen::Index i : leaves[k]) {
        const double error = std::abs(rbf_value(function, sites.points.col(i).data()) - sites.target_N[i]);
        worst_first.emplace_back(-error / jnd_N[i], k);
      }
    }
    std::sort(worst_first.begin(), worst_first.end());
    for (const auto& [excess, leaf] : worst_first)
      if (split(leaves, leaf, sites.points)) break;
  }
}

TEST(FitKdTree, EqualsAFullRefitAfterEverySplit) {
  Sites repeated = smooth_sites(3, 500, 0.05, 1);
  repeated.points.row(0) = (repeated.points.row(0).array() * 10.0).round() / 10.0;
  for (Sites sites : {smooth_sites(3, 500, 0.05, 1), repeated}) {
    const Eigen::VectorXd jnd_N = jnd_of(sites);
    for (const KernelKind kernel : kKernelKinds) {
      sites.kernel = kernel;
      const auto fitted = fit_kdtree(sites, jnd_N, {.centres = 25});
      ASSERT_TRUE(fitted.ok());
      EXPECT_EQ(fitted->centres, plain_centres(sites, jnd_N, kernel, 25)) << kernel_name(kernel);
    }
  }
}

}  // namespace
}  // namespace palpate
