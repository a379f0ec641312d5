#include "models/linear/lapack.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random_points.h"

namespace palpate {
namespace {

// Rounding of products of some numbers around 1.
constexpr double kRounding = 1e-14;

// A 4 x 3 matrix with the singular values 3, 2 and 1e-9: a column permutation and two rotations of a diagonal.
Eigen::MatrixXd with_known_values() {
  Eigen::Matrix3d right;
  right << 0.0, 0.6, -0.8, 1.0, 0.0, 0.0, 0.0, 0.8, 0.6;
  Eigen::Matrix4d left = Eigen::Matrix4d::Identity();
  left.topLeftCorner<2, 2>() << 0.8, -0.6, 0.6, 0.8;
  left.bottomRightCorner<2, 2>() << 5.0 / 13.0, -12.0 / 13.0, 12.0 / 13.0, 5.0 / 13.0;
  return left.leftCols<3>() * Eigen::Vector3d(3.0, 2.0, 1e-9).asDiagonal() * right.transpose();
}

TEST(SingularValues, AreThoseOfTheClosedForm) {
  const Eigen::MatrixXd a = with_known_values();
  for (const bool wide : {false, true}) {
    const SingularValues found = singular_values(wide ? Eigen::MatrixXd(a.transpose()) : a);
    ASSERT_EQ(found.values.size(), 3);
    EXPECT_NEAR(found.values(0), 3.0, kRounding);
    EXPECT_NEAR(found.values(1), 2.0, kRounding);
    EXPECT_NEAR(found.values(2), 1e-9, kRounding);
    const Eigen::MatrixXd product = found.u * found.values.asDiagonal() * found.vt;
    EXPECT_LT((product - (wide ? Eigen::MatrixXd(a.transpose()) : a)).norm(), kRounding);
  }
}

TEST(SingularValues, RankAndConditionNumberCountWhatIsAboveTheCut) {
  const SingularValues found = singular_values(with_known_values());
  EXPECT_EQ(found.rank(1e-12), 3);
  EXPECT_NEAR(found.condition_number(1e-12), 3e9, 3e9 * 1e-5);  // 1e-9 is known to 1e-14
  EXPECT_EQ(found.rank(1e-6), 2);
  EXPECT_NEAR(found.condition_number(1e-6), 1.5, kRounding);
  EXPECT_EQ(found.rank(0.9), 1);
  EXPECT_EQ(found.condition_number(0.9), 1.0);
}

TEST(SingularValues, ThatDidNotConvergeGiveNoNumbers) {
  SingularValues failed = singular_values(with_known_values());
  failed.values.setConstant(std::nan(""));
  const Eigen::VectorXd x = failed.solve(Eigen::VectorXd::Ones(4), 1e-6);
  ASSERT_EQ(x.size(), 3);
  EXPECT_TRUE(x.array().isNaN().all());
}

}  // namespace
}  // namespace palpate
