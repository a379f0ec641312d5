#include <gtest/gtest.h>

#include <Eigen/QR>
#include <limits>

#include "tests/support/fit_centres.h"
#include "tests/support/plain_rbf.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

using test::fit_greedy;
using test::smooth_sites;

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
    const auto fitted = fit_greedy(sites, {.centres = 12, .candidates = 0});
    ASSERT_TRUE(fitted.ok());
    EXPECT_EQ(fitted->centres, brute_force_centres(sites, kernel, 12)) << kernel_name(kernel);
  }
}

}  // namespace
}  // namespace palpate
