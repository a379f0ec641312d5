#include "models/solve/site_tree.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/support/random_points.h"

namespace palpate {
namespace {

std::map<Eigen::Index, int> leaf_sizes(const SiteTree& tree, Eigen::Index count) {
  std::map<Eigen::Index, int> sizes;
  for (Eigen::Index i = 0; i < count; ++i) ++sizes[tree.leaf_of(i)];
  return sizes;
}

TEST(SiteTree, SplitsAtTheMedianOfTheWidestDimension) {
  Eigen::MatrixXd points = test::random_points(3, 101, 1);
  points.row(1) *= 5.0;
  SiteTree tree(points);
  ASSERT_TRUE(tree.split(0));
  EXPECT_EQ(leaf_sizes(tree, 101), (std::map<Eigen::Index, int>{{0, 50}, {1, 51}}));
  for (Eigen::Index i = 0; i < 101; ++i)
    for (Eigen::Index j = 0; j < 101; ++j) {
      if (tree.leaf_of(i) < tree.leaf_of(j)) {
        EXPECT_LT(points(1, i), points(1, j));
      }
    }
}

TEST(SiteTree, BarycentreIsTheMeanOfTheLeaf) {
  const Eigen::MatrixXd points = test::random_points(2, 40, 1);
  SiteTree tree(points);
  EXPECT_LE((tree.barycentre(0) - points.rowwise().mean()).norm(), 1e-14);
  ASSERT_TRUE(tree.split(0));
  const Eigen::VectorXd both = 0.5 * (tree.barycentre(0) + tree.barycentre(1));
  EXPECT_LE((both - points.rowwise().mean()).norm(), 1e-14);
}

TEST(SiteTree, EqualPointsStayTogetherAndCannotBeSplit) {
  Eigen::MatrixXd points(1, 7);
  points << 2, 1, 2, 2, 2, 2, 2;
  SiteTree tree(points);
  ASSERT_TRUE(tree.split(0));
  EXPECT_EQ(leaf_sizes(tree, 7), (std::map<Eigen::Index, int>{{0, 1}, {1, 6}}));
  EXPECT_FALSE(tree.split(0));
  EXPECT_FALSE(tree.split(1));
  EXPECT_EQ(tree.leaf_count(), 2);
}

}  // namespace
}  // namespace palpate
