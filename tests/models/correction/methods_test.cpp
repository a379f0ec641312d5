#include "models/correction/methods.h"

#include <gtest/gtest.h>
#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "models/correction/algebra.h"
#include "tests/support/fit_centres.h"
#include "tests/support/message_parts.h"
#include "tests/support/plain_rbf.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

using test::smooth_sites;

// A base that is given is not fitted again: of another one the result differs.
TEST(Methods, StartFromTheBaseThatTheyAreGiven) {
  const Sites sites = smooth_sites(2, 60, 0.0, 1);
  MethodTask task{sites, sites.target_N};
  task.grid = {5, 5};
  const auto alone = fit_correction(kVoxelMethod, task);
  const auto direct = fit_correction(kDirectMethod, task);
  ASSERT_TRUE(alone.ok() && direct.ok());
  task.base = direct->correction;
  const Result from_direct = test::must(fit_correction(kVoxelMethod, task));
  EXPECT_EQ(grid_of(from_direct->correction)->values_N, grid_of(alone->correction)->values_N);
  task.base = fit_correction(kRandomMethod, task)->correction;
  EXPECT_NE(grid_of(fit_correction(kVoxelMethod, task)->correction)->values_N, grid_of(alone->correction)->values_N);
}

// Calls `test` with each method that selects centres; greedy ones with subsets of candidates and with all.
template <typename Test>
void for_every_selection(const Test& test) {
  for (const Method* method : methods()) {
    if (!method->can_take(kTakesCentres)) continue;
    for (const int candidates : {0, 30}) {
      SCOPED_TRACE(std::string(method->name) + ", candidates " + std::to_string(candidates));
      test(*method, candidates);
    }
  }
}

Eigen::VectorXd jnd_of(const Sites& sites) { return sites.row_scale.cwiseInverse(); }

TEST(Methods, SameDataAndSeedSameBits) {
  const Sites sites = smooth_sites(4, 1500, 0.01, 1);
  for_every_selection([&](const Method& method, int candidates) {
    const test::CentreOptions options{.centres = 25, .candidates = candidates, .seed = 9};
    const auto a = test::fit_centres(method, sites, jnd_of(sites), options);
    const auto b = test::fit_centres(method, sites, jnd_of(sites), options);
    ASSERT_TRUE(a.ok() && b.ok());
    EXPECT_TRUE(a->centres == b->centres && a->weights == b->weights && a->tail == b->tail);
  });
}

TEST(Methods, DegenerateDataHaveADefinedOutcome) {
  for_every_selection([&](const Method& method, int candidates) {
    for (const Sites& sites : test::degenerate_sites()) {
      const auto distinct = static_cast<int>(distinct_sites(sites).size());
      for (const int centres : {0, 1, 2, 30, 1000}) {
        const Eigen::VectorXd jnd_N = jnd_of(sites);
        MethodTask task{sites, jnd_N};
        task.centres = centres;
        task.candidates = candidates;
        const Result fitted = test::must(fit_correction(method, task));
        EXPECT_TRUE(rbf_of(fitted->correction)->weights.allFinite());
        const int used = fitted->correction->size();
        EXPECT_LE(used, std::min(centres, distinct));
        if (used == centres) continue;
        ASSERT_FALSE(fitted->notes.empty());
        EXPECT_TRUE(test::has_parts(fitted->notes.back(), {"only " + std::to_string(used) + " centres"}));
      }
    }
  });
  const Sites duplicates = test::degenerate_sites()[2];
  EXPECT_EQ(test::fit_kdtree(duplicates, jnd_of(duplicates), {.centres = 1000})->centre_count(), 40);
  EXPECT_EQ(test::fit_random(duplicates, {.centres = 1000})->centre_count(), 40);
}

TEST(Methods, RefuseWrongSitesAndCanBeInterrupted) {
  for_every_selection([&](const Method& method, int candidates) {
    Sites sites = smooth_sites(2, 30, 0.0, 1);
    const Eigen::VectorXd jnd_N = jnd_of(sites);
    const test::CentreOptions options{.centres = 20, .candidates = candidates};
    const auto stopped = test::fit_centres(method, sites, jnd_N, options, {[](double) { return false; }});
    EXPECT_EQ(stopped.error().message, "interrupted");
    sites.target_N[7] = std::nan("");
    EXPECT_TRUE(test::has_parts(test::fit_centres(method, sites, jnd_N, options).error().message,
                                {"not finite", "; check the recording"}));
  });
}

TEST(FitRandom, CentresAreDistinctSitesThatDependOnTheSeed) {
  Sites sites = smooth_sites(3, 60, 0.0, 1);
  sites.points.rightCols(30) = sites.points.leftCols(30);
  const Result fitted = test::must(test::fit_random(sites, {.centres = 30}));
  const Eigen::MatrixXd& centres = fitted->centres;
  for (int j = 0; j < 30; ++j) {
    EXPECT_EQ((sites.points.colwise() - centres.col(j)).colwise().norm().minCoeff(), 0.0);
    for (int k = 0; k < j; ++k) EXPECT_GT((centres.col(j) - centres.col(k)).norm(), 0.0);
  }
  EXPECT_NE(centres, test::fit_random(sites, {.centres = 30, .seed = 6})->centres);
}

TEST(FitDirect, SolvesTheEquationsOfTheSplineAlwaysToTheSameBits) {
  for (const int count : {700, 4200}) {  // by a factor, and by conjugate gradients
    Sites sites = smooth_sites(4, count, 0.01, 1);
    sites.smoothing = 30.0;
    const auto solved = solve_direct(sites), again = solve_direct(sites);
    ASSERT_TRUE(solved.ok() && again.ok());
    const RbfFunction& spline = solved->function();
    EXPECT_TRUE(spline.weights == again->function().weights && spline.tail == again->function().tail);
    Eigen::VectorXd force_N;
    RbfCorrection(spline).evaluate_many(sites.points, force_N);
    const Eigen::VectorXd error = sites.row_scale.cwiseAbs2().cwiseProduct(sites.target_N - force_N);
    // The iteration ends with a residual of 1e-12 of the norm of the data.
    EXPECT_LT((error - sites.smoothing * spline.weights).lpNorm<Eigen::Infinity>(), 1e-8);
  }
}

TEST(FitDirect, RefusesTooManySitesAndCanBeInterrupted) {
  Sites large;
  large.points = Eigen::MatrixXd::Zero(1, kMostDirectSites + 1);
  large.target_N = large.row_scale = Eigen::VectorXd::Ones(kMostDirectSites + 1);
  EXPECT_TRUE(test::has_parts(solve_direct(large).error().message, {"20001", "too large", "20000", "; "}));
  const Sites sites = smooth_sites(2, 300, 0, 1);
  std::vector<double> asked;
  ASSERT_TRUE(solve_direct(sites, {[&](double f) { return asked.push_back(f), true; }}).ok());
  EXPECT_TRUE(std::is_sorted(asked.begin(), asked.end()));
  EXPECT_EQ(asked.size(), 5u) << "at the start, before and within the factorisation (two blocks), and after it";
  for (const double fraction : asked) {
    const auto stopped = solve_direct(sites, {[&](double f) { return f < fraction; }});
    ASSERT_FALSE(stopped.ok());
    EXPECT_EQ(stopped.error().message, "interrupted") << fraction;
  }
}

using test::fit_greedy;

// Section 4.2.3 literally: tries every site by solving the whole least squares
// problem.
Eigen::MatrixXd brute_force_centres(const Sites& sites, KernelKind kernel, int count) {
  Eigen::MatrixXd matrix = tail_matrix(tail_degree(kernel), sites.points).array().colwise() * sites.row_scale.array();
  const Eigen::VectorXd data = sites.target_N.cwiseProduct(sites.row_scale);
  Eigen::MatrixXd centres(sites.dimension(), count);
  for (int step = 0; step < count; ++step) {
    matrix.conservativeResize(Eigen::NoChange, matrix.cols() + 1);
    double best_error = std::numeric_limits<double>::max();
    Eigen::VectorXd best_column;
    for (Eigen::Index j = 0; j < sites.count(); ++j) {
      for (Eigen::Index i = 0; i < sites.count(); ++i)
        matrix(i, matrix.cols() - 1) =
            sites.row_scale[i] * kernel_value(kernel, (sites.points.col(i) - sites.points.col(j)).norm());
      const Eigen::VectorXd solution = matrix.colPivHouseholderQr().solve(data);
      const double error = (data - matrix * solution).squaredNorm();
      if (error < best_error) {
        best_error = error;
        best_column = matrix.rightCols(1);
        centres.col(step) = sites.points.col(j);
      }
    }
    matrix.rightCols(1) = best_column;
  }
  return centres;
}

TEST(FitGreedy, AllSitesEqualsBruteForceForwardSelection) {
  Sites sites = smooth_sites(2, 60, 0.05, 1);
  for (const KernelKind kernel : kKernelKinds) {
    sites.kernel = kernel;
    const Result fitted = test::must(fit_greedy(sites, {.centres = 12, .candidates = 0}));
    EXPECT_EQ(fitted->centres, brute_force_centres(sites, kernel, 12)) << kernel_name(kernel);
  }
}

using test::fit_kdtree;

Eigen::VectorXd jnd_line_of(const Sites& sites) { return (0.065 + 0.0633 * sites.target_N.array().abs()).matrix(); }

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
    const Eigen::VectorXd jnd_N = jnd_line_of(sites);
    for (const KernelKind kernel : kKernelKinds) {
      sites.kernel = kernel;
      const Result fitted = test::must(fit_kdtree(sites, jnd_N, {.centres = 25}));
      EXPECT_EQ(fitted->centres, plain_centres(sites, jnd_N, kernel, 25)) << kernel_name(kernel);
    }
  }
}

}  // namespace
}  // namespace palpate
