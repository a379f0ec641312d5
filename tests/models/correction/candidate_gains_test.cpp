#include "models/correction/orthogonal_basis.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <vector>

#include "models/model/kernels.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

// (c . r)^2 / |c'|^2 from a QR factorisation of all columns chosen so far.
double gain_from_scratch(const Sites& sites, const CandidateGains& gains, const std::vector<Eigen::Index>& chosen,
                         Eigen::Index site) {
  const Eigen::MatrixXd tail = tail_matrix(tail_degree(KernelKind::cubic), sites.points);
  Eigen::MatrixXd columns(sites.count(), tail.cols() + static_cast<Eigen::Index>(chosen.size()));
  columns.leftCols(tail.cols()) = sites.row_scale.asDiagonal() * tail;
  for (std::size_t k = 0; k < chosen.size(); ++k)
    columns.col(tail.cols() + static_cast<Eigen::Index>(k)) = gains.columns({&chosen[k], 1});
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), columns.cols());
  const auto outside = [&](Eigen::VectorXd v) {
    for (int pass = 0; pass < 2; ++pass) v -= q * (q.transpose() * v);
    return v;
  };
  const Eigen::VectorXd c = outside(gains.columns({&site, 1}));
  const Eigen::VectorXd r = outside(sites.target_N.cwiseProduct(sites.row_scale));
  return c.dot(r) * c.dot(r) / c.squaredNorm();
}

// Candidates are updated at various intervals: some at every step, some rarely. The
// cached gains must equal those computed from scratch.
TEST(CandidateGains, AreThoseOfAFreshLookHoweverLongAgoTheLastWas) {
  const Sites sites = test::smooth_sites(4, 400, 0.005, 3);
  CandidateGains gains(sites);
  OrthogonalBasis basis(sites, 60);
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index step = 0; step < 60; ++step) {
    std::vector<Eigen::Index> looked_at{399};
    for (Eigen::Index k = 0; k < 12; ++k) looked_at.push_back((step * 37 + k * 29) % 398);
    gains.update(looked_at, basis);
    const Eigen::Index next = looked_at[1];
    if (step % 20 == 0 || step > 57)
      for (const Eigen::Index site : looked_at) {
        if (std::find(chosen.begin(), chosen.end(), site) != chosen.end()) {
          EXPECT_EQ(gains.gain(site), 0.0) << "chosen already: site " << site;
          continue;
        }
        const double expected = gain_from_scratch(sites, gains, chosen, site);
        EXPECT_NEAR(gains.gain(site), expected, 1e-6 * expected) << "site " << site << " at step " << step;
      }
    if (std::find(chosen.begin(), chosen.end(), next) != chosen.end()) continue;
    basis.add(gains.columns({&next, 1}));
    chosen.push_back(next);
  }
  EXPECT_GT(chosen.size(), 50U);
  const Eigen::Index never_seen = 398;
  gains.update({&never_seen, 1}, basis);
  const double expected = gain_from_scratch(sites, gains, chosen, never_seen);
  EXPECT_NEAR(gains.gain(never_seen), expected, 1e-6 * expected);
}

// Close to a chosen centre a column is almost in the span of the basis. The difference
// of squares then has no correct digits, but the orthogonalised column has.
TEST(CandidateGains, KnowsAColumnAllButInsideTheBasis) {
  Sites sites = test::smooth_sites(4, 300, 0.005, 5);
  sites.points.col(1) = sites.points.col(0).array() + 1e-5;
  sites.points.col(2) = sites.points.col(0);
  CandidateGains gains(sites);
  OrthogonalBasis basis(sites, 1);
  const Eigen::Index chosen = 0;
  basis.add(gains.columns({&chosen, 1}));
  const std::vector<Eigen::Index> looked_at{1, 2};
  gains.update(looked_at, basis);
  const double expected = gain_from_scratch(sites, gains, {0}, 1);
  EXPECT_NEAR(gains.gain(1), expected, 0.01 * expected);
  EXPECT_EQ(gains.gain(2), 0.0) << "a repeated point adds nothing";
}

// Columns that differ by 1e-7 of their length: one pass of Gram-Schmidt leaves 1e-9 of each in the others.
TEST(OrthogonalBasis, IsOrthogonalForColumnsThatAreAlmostTheSame) {
  const Sites sites = test::smooth_sites(2, 200, 0.0, 3);
  const Eigen::MatrixXd random = test::random_points(200, 11, 7);
  OrthogonalBasis basis(sites, 10);
  for (Eigen::Index k = 1; k <= 10; ++k) EXPECT_TRUE(basis.add(random.col(0) + 1e-7 * random.col(k)));
  const Eigen::MatrixXd q = basis.data_and_columns().rightCols(basis.size());
  const Eigen::MatrixXd error = q.transpose() * q - Eigen::MatrixXd::Identity(q.cols(), q.cols());
  EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-13);
}

}  // namespace
}  // namespace palpate
