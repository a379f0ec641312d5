#include "models/correction/algebra.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>

#include "models/correction/methods.h"
#include "models/model/correction.h"
#include "tests/support/message_parts.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

using test::random_points;
using test::smooth_sites;

Result<RbfFunction> function_of(const Sites& sites) {
  auto solved = solve_direct(sites);
  if (!solved) return solved.error();
  return solved->function();
}

TEST(FitDirect, SameDataSameBits) {
  const Sites sites = smooth_sites(4, 700, 0.01, 1);
  const auto a = function_of(sites);
  const auto b = function_of(sites);
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_EQ(a->weights, b->weights);
  EXPECT_EQ(a->tail, b->tail);
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

}  // namespace
}  // namespace palpate
