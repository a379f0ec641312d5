#include "models/model/correction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tests/support/random_points.h"

namespace palpate {
namespace {

using test::Numbers;
using test::random_points;

// Ascending nodes from -1 to 1 with steps that differ a thousandfold.
VoxelGrid even_grid(double low, double high, const std::vector<int>& sizes) {
  VoxelGrid grid;
  for (const int size : sizes) {
    std::vector<double>& axis = grid.nodes.emplace_back();
    for (int i = 0; i < size; ++i) axis.push_back(low + (high - low) * i / (size - 1));
  }
  return grid;
}

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

TEST(GridCorrection, ReproducesAMultilinearFunction) {
  VoxelGrid grid = even_grid(-1.0, 2.0, {4, 2, 7});
  const auto value = [](const auto& x) { return 1.0 + x[0] - 2.0 * x[1] * x[2] + 0.5 * x[0] * x[1] * x[2]; };
  ASSERT_TRUE(fill_grid(grid, [&](const Eigen::MatrixXd& points, Eigen::VectorXd& out) {
                for (Eigen::Index i = 0; i < points.cols(); ++i) out[i] = value(points.col(i));
              }).ok());
  const GridCorrection lookup(grid);
  const Eigen::MatrixXd queries = random_points(3, 100, 2);
  for (Eigen::Index i = 0; i < queries.cols(); ++i)
    EXPECT_NEAR(lookup.evaluate(queries.col(i).data()), value(queries.col(i)), 1e-14);
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

}  // namespace
}  // namespace palpate
