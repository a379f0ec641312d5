#include "models/model/correction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/plain_rbf.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

using test::random_function;
using test::random_points;

long double reference(const RbfFunction& f, const double* x, long double* size) {
  const int d = f.dimension();
  long double sum = tail_value(f.tail.data(), tail_degree(f.kernel), d, x);
  *size = std::abs(f.tail[0]);
  for (Eigen::Index k = 1; k < f.tail.size(); ++k) *size += std::abs(f.tail[k]);
  for (Eigen::Index j = 0; j < f.centre_count(); ++j) {
    long double squared = 0;
    for (int k = 0; k < d; ++k) {
      const long double difference = static_cast<long double>(x[k]) - f.centres(k, j);
      squared += difference * difference;
    }
    const long double r = std::sqrt(squared);
    long double phi = r;
    if (f.kernel == KernelKind::cubic) phi = r * r * r;
    if (f.kernel == KernelKind::thin_plate) phi = r > 0 ? squared * std::log(r) : 0;
    sum += f.weights[j] * phi;
    *size += std::abs(f.weights[j]) * (f.kernel == KernelKind::thin_plate ? std::abs(phi) + squared : std::abs(phi));
  }
  return sum;
}

// Runs with every instruction set of this machine, then restores the best.
class RbfCorrectionOnTarget : public ::testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { simd::use_target(GetParam()); }
  void TearDown() override { simd::use_target(0); }
};

INSTANTIATE_TEST_SUITE_P(Targets, RbfCorrectionOnTarget, ::testing::ValuesIn(simd::all_targets()),
                         [](const auto& instance) {
                           simd::use_target(instance.param);
                           std::string name = simd::target_name();
                           simd::use_target(0);
                           return name;
                         });

// The error bound of correction.h: 32 eps times the sum of absolute terms.
TEST_P(RbfCorrectionOnTarget, AgreesWithALongDoubleReferenceForEveryKernelAndDimension) {
  for (const KernelKind kernel : kKernelKinds)
    for (int d = 1; d <= static_cast<int>(kMaxFeatures); ++d)
      for (const int n : {0, 1, 7, 8, 9, 16, 100}) {
        const RbfFunction f = random_function(kernel, d, n, static_cast<std::uint64_t>(100 * d + n));
        const RbfCorrection evaluator(f);
        const Eigen::MatrixXd queries = random_points(d, 20, 5);
        for (int i = 0; i < 20; ++i) {
          long double size = 0;
          const long double expected = reference(f, queries.col(i).data(), &size);
          EXPECT_NEAR(evaluator.evaluate(queries.col(i).data()), static_cast<double>(expected),
                      static_cast<double>(32 * 0x1p-53L * size))
              << kernel_name(kernel) << " d=" << d << " n=" << n;
        }
      }
}

TEST_P(RbfCorrectionOnTarget, KernelsKeepTheirRelativeAccuracyFromTinyToHugeDistances) {
  RbfFunction f = random_function(KernelKind::cubic, 1, 16, 1);
  f.centres.setZero();
  f.weights.setConstant(1.0 / 16.0);
  f.tail.setZero();
  const RbfCorrection evaluator(f);
  for (double r = 1.1e-18; r < 1e50; r *= 3.7) EXPECT_NEAR(evaluator.evaluate(&r) / (r * r * r), 1.0, 6 * 0x1p-52) << r;
  for (const double r : {0.0, 1e-90, 1e-25, 0.9e-18}) EXPECT_NEAR(evaluator.evaluate(&r), 1e-54, 1e-66) << r;
}

TEST_P(RbfCorrectionOnTarget, ANonFiniteQueryGivesANonFiniteResult) {
  const RbfCorrection evaluator(random_function(KernelKind::cubic, 2, 20, 3));
  for (const double bad : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    const double x[] = {0.1, bad};
    EXPECT_FALSE(std::isfinite(evaluator.evaluate(x)));
  }
}

TEST_P(RbfCorrectionOnTarget, ManyPointsAtOnceGiveTheSameBits) {
  const RbfCorrection evaluator(random_function(KernelKind::cubic, 4, 3000, 3));
  const Eigen::MatrixXd queries = random_points(4, 1001, 8);
  Eigen::VectorXd out;
  evaluator.evaluate_many(queries, out);
  for (Eigen::Index i = 0; i < queries.cols(); ++i) EXPECT_EQ(out[i], evaluator.evaluate(queries.col(i).data()));
}

// Each entry is within the 4 ulp (thin-plate: 8) of the header.
TEST_P(RbfCorrectionOnTarget, KernelMatrixAgreesWithTheScalarKernel) {
  for (const KernelKind kernel : kKernelKinds)
    for (const int rows : {1, 5, 8, 33}) {
      const Eigen::MatrixXd points = random_points(3, rows, 1);
      const Eigen::MatrixXd centres = random_points(3, 4, 2);
      Eigen::MatrixXd out(rows, 4);
      kernel_matrix(kernel, PointArrays(points), centres, out);
      for (int i = 0; i < rows; ++i)
        for (int j = 0; j < 4; ++j) {
          const double r = (points.col(i) - centres.col(j)).norm();
          EXPECT_NEAR(out(i, j), kernel_value(kernel, r), 1e-14 * (1.0 + r * r * r * r * r));
        }
    }
}

}  // namespace
}  // namespace palpate
