// Properties of every virtual material.
#include "scenes/material/material.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tests/support/rt_guard.h"
#include "tests/support/wandering.h"

namespace palpate {
namespace {

using test::depth_of_5_N;
using test::Wandering;

using BlockPtr = std::unique_ptr<Block>;

// The work of a motion by the trapezoidal rule.
struct Work {
  void add(double position_m, double force_N) {
    const double part_J = 0.5 * (force_N + last_N) * (position_m - last_m);
    net_J += part_J;
    put_in_J += std::max(0.0, part_J);
    last_N = force_N;
    last_m = position_m;
  }
  double net_J = 0.0, put_in_J = 0.0, last_N = 0.0, last_m = 0.0;
};

class EveryBlock : public testing::TestWithParam<Material> {};

INSTANTIATE_TEST_SUITE_P(Block, EveryBlock, testing::ValuesIn(materials()),
                         [](const auto& instance) { return std::string(instance.param.name); });

// The error of the cubic interpolation between rows is v'''' dt^4 / 384. At 12 Hz and
// 500 Hz this is below 0.3 um of depth, a thousandth of the stiffest force.
TEST_P(EveryBlock, SameMotionGivesTheSameForceAtEveryRate) {
  const BlockPtr blocks[] = {GetParam().make_block(), GetParam().make_block(), GetParam().make_block(),
                             GetParam().make_block()};
  const double rates_Hz[] = {500.0, 1000.0, 2000.0, 20000.0};
  const Wandering motion(4, depth_of_5_N(*blocks[0]));
  double worst_N = 0.0, strongest_N = 0.0;
  for (int row = 1; row <= 5000; ++row) {
    for (int k = 0; k < 4; ++k) {
      const int steps = static_cast<int>(rates_Hz[k] / 500.0);
      for (int i = 1; i <= steps; ++i) {
        const double t = (row - 1) / 500.0 + i / rates_Hz[k];
        blocks[k]->step(motion.position_m(t), motion.velocity_m_per_s(t), 1.0 / rates_Hz[k]);
      }
    }
    strongest_N = std::max(strongest_N, blocks[3]->force_N());
    for (int k = 0; k < 3; ++k) {
      worst_N = std::max(worst_N, std::abs(blocks[k]->force_N() - blocks[3]->force_N()));
    }
  }
  EXPECT_LT(worst_N, 0.01 * strongest_N) << "a tenth of the smallest JND's slope";
  EXPECT_LT(worst_N, 0.065) << "below any JND";
}

// From rest on, the net work put in is never negative at any time, so that the material
// is passive.
TEST_P(EveryBlock, IsPassive) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const BlockPtr block = GetParam().make_block();
    const Wandering motion(seed, depth_of_5_N(*block));
    const double dt = 1e-4;
    Work work;
    for (int i = 1; i <= 100000; ++i) {
      work.add(motion.position_m(i * dt), block->step(motion.position_m(i * dt), motion.velocity_m_per_s(i * dt), dt));
      // The error of the trapezoidal rule, h^2/12 F'' dx, is below 1e-5 of the
      // energy put in.
      ASSERT_GE(work.net_J, -1e-5 * work.put_in_J) << "seed " << seed << " row " << i;
    }
  }
}

TEST_P(EveryBlock, NeverPullsAndHasNoForceInTheAir) {
  const BlockPtr block = GetParam().make_block();
  const Wandering motion(11, 1.5 * depth_of_5_N(*block));
  for (int i = 1; i <= 20000; ++i) {
    const double position_m = motion.position_m(i * 1e-3);
    const double force_N = block->step(position_m, motion.velocity_m_per_s(i * 1e-3), 1e-3);
    ASSERT_TRUE(std::isfinite(force_N));
    ASSERT_GE(force_N, 0.0);
    ASSERT_GE(block->surface_depth_m(), std::max(0.0, position_m));
    if (position_m <= 0.0) {
      ASSERT_EQ(force_N, 0.0);
    }
  }
}

TEST_P(EveryBlock, StepNeverAllocatesOrLocks) {
  if (!test::rt_guard_works()) GTEST_SKIP() << "a sanitizer owns malloc";
  const BlockPtr block = GetParam().make_block();
  const Wandering motion(5, depth_of_5_N(*block));
  test::RtGuard guard;
  for (int i = 1; i <= 10000; ++i) {
    block->step(motion.position_m(i * 1e-3), motion.velocity_m_per_s(i * 1e-3), 1e-3);
  }
  EXPECT_EQ(guard.stop().total(), 0);
}

}  // namespace
}  // namespace palpate
