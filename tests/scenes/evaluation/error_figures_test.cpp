#include "scenes/evaluation/model_errors.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

constexpr double kRounding = 1e-12;  // a few roundings of doubles

TEST(ForceBins, AreTwoJndWideAtEveryForce) {
  for (const JndLine jnd : {JndLine{}, JndLine{0.5, 0.0}, JndLine{1e-3, 0.2}}) {
    for (const double force_N : {0.01, 0.3, 6.0, 30.0, 3000.0}) {
      const std::size_t bin = force_bin(force_N, jnd);
      if (bin + 1 == kMaximumForceBins) continue;  // contains all larger forces
      const double from_N = force_bin_begin_N(bin, jnd);
      const double to_N = force_bin_begin_N(bin + 1, jnd);
      EXPECT_LE(from_N, force_N * (1.0 + kRounding));
      EXPECT_GT(to_N, force_N * (1.0 - kRounding));
      // The integral of dF / JND over the bin, by the midpoint rule with 1000 steps.
      double jnds = 0.0;
      const double step_N = (to_N - from_N) / 1000.0;
      for (int i = 0; i < 1000; ++i) jnds += step_N / jnd.at(from_N + (i + 0.5) * step_N);
      EXPECT_NEAR(jnds, kBinWidth_jnd, 1e-4);
    }
  }
  EXPECT_EQ(force_bin(0.3, {}), 2u) << "the third of three";
  EXPECT_EQ(force_bin(6.0, {}), 15u);
  EXPECT_EQ(force_bin(3000.0, {}), 63u);
  EXPECT_EQ(force_bin(-0.02, {}), 0u) << "sensor noise";
}

}  // namespace
}  // namespace palpate
