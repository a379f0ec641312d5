#include "models/solve/inner_products_simd.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "models/model/rbf/rbf_simd.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

// Rows that fill no vector, counts of directions that fill no tile, on every instruction set.
// To 1e-13: 45 roundings of sums below 45.
TEST(InnerProducts, AreThoseOfTheDefinition) {
  const Eigen::MatrixXd directions = test::random_points(45, 20, 1);
  const Eigen::MatrixXd columns = test::random_points(45, 4, 2);
  for (const std::string& target : simd::target_names()) {
    ASSERT_TRUE(simd::choose_target(target));
    const auto inner_products = simd::inner_products_function();
    for (const Eigen::Index rows : {0, 1, 7, 8, 16, 45}) {
      for (Eigen::Index count = 0; count <= directions.cols(); ++count) {
        Eigen::MatrixXd shares = Eigen::MatrixXd::Constant(4, directions.cols(), 0.25);
        inner_products(directions.data(), 45, static_cast<std::size_t>(count), columns.data(), 45,
                       static_cast<std::size_t>(rows), shares.data());
        Eigen::MatrixXd expected = Eigen::MatrixXd::Constant(4, directions.cols(), 0.25);
        expected.leftCols(count) += columns.topRows(rows).transpose() * directions.topRows(rows).leftCols(count);
        EXPECT_LT((shares - expected).cwiseAbs().maxCoeff(), 1e-13) << target << " " << rows << " " << count;
      }
    }
  }
  simd::choose_target("");
}

TEST(ScaleColumn, ScalesAndAddsUpTheSquares) {
  const Eigen::VectorXd scale = test::random_points(1, 45, 3).transpose();
  for (const std::string& target : simd::target_names()) {
    ASSERT_TRUE(simd::choose_target(target));
    for (const Eigen::Index rows : {0, 1, 8, 45}) {
      const Eigen::VectorXd before = test::random_points(1, 45, 4).transpose();
      Eigen::VectorXd column = before;
      double squared = 2.0;
      simd::scale_column_function()(column.data(), scale.data(), static_cast<std::size_t>(rows), &squared);
      EXPECT_EQ(column.head(rows), before.head(rows).cwiseProduct(scale.head(rows)));
      EXPECT_EQ(column.tail(45 - rows), before.tail(45 - rows));
      EXPECT_NEAR(squared, 2.0 + column.head(rows).squaredNorm(), 1e-13);
    }
  }
  simd::choose_target("");
}

}  // namespace
}  // namespace palpate
