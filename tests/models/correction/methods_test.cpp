#include "models/correction/methods.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models/model/correction.h"
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
  const auto from_direct = fit_correction(kVoxelMethod, task);
  ASSERT_TRUE(from_direct.ok());
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
    EXPECT_EQ(a->centres, b->centres);
    EXPECT_EQ(a->weights, b->weights);
    EXPECT_EQ(a->tail, b->tail);
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
        const auto fitted = fit_correction(method, task);
        ASSERT_TRUE(fitted.ok());
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
  const auto fitted = test::fit_random(sites, {.centres = 30});
  ASSERT_TRUE(fitted.ok());
  const Eigen::MatrixXd& centres = fitted->centres;
  for (int j = 0; j < 30; ++j) {
    EXPECT_EQ((sites.points.colwise() - centres.col(j)).colwise().norm().minCoeff(), 0.0);
    for (int k = 0; k < j; ++k) EXPECT_GT((centres.col(j) - centres.col(k)).norm(), 0.0);
  }
  EXPECT_NE(centres, test::fit_random(sites, {.centres = 30, .seed = 6})->centres);
}

}  // namespace
}  // namespace palpate
