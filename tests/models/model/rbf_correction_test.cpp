#include "models/model/correction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "models/model/fitted_model.h"
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

using test::Numbers;

VoxelGrid uneven_grid(int dimension, int size, std::uint64_t seed) {
  Numbers numbers(seed);
  VoxelGrid grid;
  std::size_t count = 1;
  for (int k = 0; k < dimension; ++k) {
    std::vector<double>& axis = grid.nodes.emplace_back(1, 0.0);
    for (int i = 1; i < size; ++i) axis.push_back(axis.back() + std::pow(10.0, 1.5 * numbers.next()));
    const double extent = axis.back();
    for (double& node : axis) node = 2.0 * node / extent - 1.0;
    count *= static_cast<std::size_t>(size);
  }
  for (std::size_t i = 0; i < count; ++i) grid.values_N.push_back(numbers.next());
  return grid;
}

// The reference, in plain loops.
double plain_value(const VoxelGrid& grid, const double* x) {
  std::array<std::size_t, kMaxFeatures> cell{};
  std::array<double, kMaxFeatures> fraction{};
  const std::size_t d = grid.nodes.size();
  for (std::size_t k = 0; k < d; ++k) {
    const std::vector<double>& axis = grid.nodes[k];
    const double at = std::clamp(x[k], axis.front(), axis.back());
    const auto above = std::upper_bound(axis.begin() + 1, axis.end() - 1, at);
    cell[k] = static_cast<std::size_t>(above - axis.begin()) - 1;
    fraction[k] = (at - axis[cell[k]]) / (axis[cell[k] + 1] - axis[cell[k]]);
  }
  double sum = 0.0;
  for (std::size_t corner = 0; corner < (std::size_t{1} << d); ++corner) {
    std::size_t index = 0;
    double weight = 1.0;
    for (std::size_t k = 0; k < d; ++k) {
      const std::size_t upper = (corner >> k) & 1U;
      index = index * grid.nodes[k].size() + cell[k] + upper;
      weight *= upper ? fraction[k] : 1.0 - fraction[k];
    }
    sum += weight * grid.values_N[index];
  }
  return sum;
}

// Both interpolate between the same values of size 1. The tolerance is the rounding
// error of a coordinate relative to the narrowest cell: 1e-16 / 1e-4.
TEST(GridCorrection, AgreesWithThePlainGridInsideAndOutsideTheBox) {
  for (int d = 1; d <= static_cast<int>(kMaxFeatures); ++d) {
    const VoxelGrid grid = uneven_grid(d, d <= 4 ? 9 : 3, 5);
    const GridCorrection lookup(grid);
    const Eigen::MatrixXd queries = 1.3 * random_points(d, 300, 2);
    for (Eigen::Index i = 0; i < queries.cols(); ++i)
      EXPECT_NEAR(lookup.evaluate(queries.col(i).data()), plain_value(grid, queries.col(i).data()), 1e-11) << d;
  }
}

TEST(GridCorrection, ClampsInfinitiesAndTakesNanAsTheLowerEdge) {
  const VoxelGrid grid = uneven_grid(1, 5, 3);
  const GridCorrection lookup(grid);
  const double infinity = std::numeric_limits<double>::infinity();
  const double below = -infinity;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_DOUBLE_EQ(lookup.evaluate(&infinity), grid.values_N.back());
  EXPECT_DOUBLE_EQ(lookup.evaluate(&below), grid.values_N.front());
  EXPECT_DOUBLE_EQ(lookup.evaluate(&nan), grid.values_N.front());
}

double nearest(const Eigen::MatrixXd& points, const Eigen::VectorXd& x) {
  return (points.colwise() - x).colwise().norm().minCoeff();
}

TEST(DomainGuard, EverySiteIsCoveredAndTrusted) {
  for (const int dimension : {1, 2, 4, 8}) {
    for (const int count : {1, 50, 4000}) {
      const Eigen::MatrixXd sites = random_points(dimension, count, 3);
      const DomainCover cover = make_cover(sites);
      ASSERT_LE(cover.points.cols(), kMaximumCoverPoints);
      ASSERT_GT(cover.outer_radius, cover.inner_radius);
      const DomainGuard guard(cover);
      for (Eigen::Index i = 0; i < sites.cols(); ++i) {
        ASSERT_LE(nearest(cover.points, sites.col(i)), cover.inner_radius);
        ASSERT_EQ(guard.trust(sites.col(i).data()), 1.0) << dimension << "-D, site " << i << " of " << count;
      }
    }
  }
}

TEST(DomainGuard, FarAwayThereIsNoTrust) {
  const Eigen::MatrixXd sites = random_points(3, 500, 4);
  const DomainGuard guard(make_cover(sites));
  for (const double far : {10.0, 1e6, 1e300}) {
    EXPECT_EQ(guard.trust(Eigen::Vector3d(far, -far, 0.0).eval().data()), 0.0);
  }
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(guard.trust(Eigen::Vector3d(0.0, bad, 0.0).eval().data()), 0.0);
  }
}

class NearestPointsOnTarget : public testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { simd::use_target(GetParam()); }
  void TearDown() override { simd::use_target(0); }
};

TEST_P(NearestPointsOnTarget, TheDistanceIsThatOfABruteForceSearch) {
  for (int d = 1; d <= static_cast<int>(kMaxFeatures); ++d)
    for (const int count : {1, 31, 32, 33, 200, 768, 5000}) {
      const Eigen::MatrixXd points = random_points(d, count, 1);
      const NearestDistance distance(points);
      const Eigen::MatrixXd queries = random_points(d, 20, 9);
      for (int i = 0; i < 20; ++i) {
        const double scale = queries.col(i).norm() + points.colwise().norm().maxCoeff();
        EXPECT_NEAR(std::sqrt(distance.squared(queries.col(i).data())), nearest(points, queries.col(i)),
                    3e-7 * scale + 1e-10);
      }
    }
}

// The cell of the last query is examined first. A force must not depend on that, to the last bit, also far from the
// origin, where single precision has few digits; nor on whether a search ended at a point that was near enough.
TEST_P(NearestPointsOnTarget, AResultDoesNotDependOnTheQueriesBefore) {
  for (const int d : {1, 3, 8})
    for (const double shift : {0.0, 300.0}) {
      const Eigen::MatrixXd points = random_points(d, 768, 1).array() + shift;
      const Eigen::MatrixXd queries = random_points(d, 200, 9).array() + shift;
      const NearestDistance used(points), near(points);
      for (int i = 0; i < 200; ++i) {
        const double* query = queries.col(i).data();
        const double squared = NearestDistance(points).squared(query);
        EXPECT_EQ(used.squared(query), squared);
        const auto enough = static_cast<float>(squared);
        EXPECT_EQ(near.squared(query, enough), 0.0);
        EXPECT_EQ(near.squared(query, std::nextafter(enough, 0.0F)), squared > 0.0 ? squared : 0.0);
      }
    }
}

INSTANTIATE_TEST_SUITE_P(All, NearestPointsOnTarget, testing::ValuesIn(simd::all_targets()), [](const auto& instance) {
  simd::use_target(instance.param);
  std::string name = simd::target_name();
  simd::use_target(0);
  return name;
});

}  // namespace
}  // namespace palpate
