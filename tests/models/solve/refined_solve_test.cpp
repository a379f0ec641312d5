#include "models/solve/refined_solve.h"

#include <gtest/gtest.h>

#include "models/solve/lapack.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

bool go_on(double) { return true; }

Eigen::VectorXd in_double(const ProjectedKernel& kernel, double smoothing) {
  Eigen::MatrixXd matrix = kernel.matrix(kernel.mean_eigenvalue(), smoothing);
  EXPECT_TRUE(cholesky_in_place(matrix));
  Eigen::VectorXd u = kernel.data();
  cholesky_solve(matrix, u);
  return kernel.project(u);
}

// Both are left with a residual of about 1e-12 of the right-hand side, which is up to
// `condition` times that in u; of the quintic kernel, whose values before the projection
// are the largest, with more, and with the same.
TEST(RefinedSolve, IsThatOfDoublePrecision) {
  for (const KernelKind kind : kKernelKinds) {
    const Sites sites = test::smooth_sites(3, 700, 0.01, 1);
    const ProjectedKernel kernel(sites, kind);
    for (const double share : {1.0, 1e-2, 1e-4}) {
      const double smoothing = share * kernel.mean_eigenvalue();
      const auto refined = solve_refined(kernel, smoothing, go_on);
      ASSERT_TRUE(refined) << kernel_name(kind) << share;
      const Eigen::VectorXd expected = in_double(kernel, smoothing);
      EXPECT_LE((refined->u - expected).norm(), 1e-12 * refined->condition * expected.norm())
          << kernel_name(kind) << share;
      const auto residual = [&](const Eigen::VectorXd& u) {
        return (kernel.data() - kernel.multiply(u) - smoothing * u).norm();
      };
      EXPECT_LE(residual(refined->u), 1e-11 * kernel.data().norm() + 3.0 * residual(expected))
          << kernel_name(kind) << share;
    }
  }
}

TEST(RefinedSolve, LeavesWhatIsIllConditionedToDoublePrecision) {
  const Sites sites = test::smooth_sites(2, 300, 0.0, 1);
  const ProjectedKernel kernel(sites, KernelKind::cubic);
  EXPECT_FALSE(solve_refined(kernel, kernel.smallest_smoothing(), go_on));
}

TEST(RefinedSolve, StopsWhenItIsTold) {
  const Sites sites = test::smooth_sites(2, 300, 0.01, 1);
  const ProjectedKernel kernel(sites, KernelKind::cubic);
  EXPECT_FALSE(solve_refined(kernel, kernel.mean_eigenvalue(), [](double) { return false; }));
  EXPECT_TRUE(solve_refined(kernel, kernel.mean_eigenvalue(), go_on));
}

}  // namespace
}  // namespace palpate
