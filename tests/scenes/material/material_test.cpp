// Properties of every virtual material.
#include "scenes/material/material.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "tests/support/message_parts.h"
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

// A cycle to `deep_m` and back within `period_s`.
Work cycle(Block& block, double deep_m, double period_s, double dt) {
  Work work;
  const int steps = static_cast<int>(std::lround(period_s / dt));
  const double rate = 2.0 * 3.14159265358979324 / period_s;
  for (int i = 1; i <= steps; ++i) {
    const double position_m = 0.5 * deep_m * (1.0 - std::cos(rate * i * dt));
    work.add(position_m, block.step(position_m, 0.5 * deep_m * rate * std::sin(rate * i * dt), dt));
  }
  return work;
}

class EveryBlock : public testing::TestWithParam<Material> {};

INSTANTIATE_TEST_SUITE_P(Block, EveryBlock, testing::ValuesIn(materials()),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(EveryBlock, OneLongStepEqualsItsSubsteps) {
  const BlockPtr coarse = GetParam().make_block(), fine = GetParam().make_block();
  coarse->reset(-1e-3);
  fine->reset(-1e-3);
  const double v = 0.05;
  for (int tick = 1; tick <= 100; ++tick) {
    const double from_m = -1e-3 + v * 1e-3 * (tick - 1);
    // The first step starts at rest and is not linear, so both take the same one.
    if (tick == 1) {
      coarse->step(from_m, v, 1e-4);
      fine->step(from_m, v, 1e-4);
    }
    const double once_N = coarse->step(from_m + v * 1e-3, v, 1e-3);
    for (int i = 1; i <= 10; ++i) fine->step(from_m + v * 1e-4 * i, v, 1e-4);
    ASSERT_NEAR(once_N, fine->force_N(), 1e-10);
  }
}

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

TEST_P(EveryBlock, ClosedCycleLosesEnergyUnlessElastic) {
  const BlockPtr block = GetParam().make_block();
  const double deep_m = depth_of_5_N(*block);
  for (int repeat = 0; repeat < 3; ++repeat) {
    const Work work = cycle(*block, deep_m, 0.5, 1e-4);
    if (GetParam().name == "elastic") {
      EXPECT_NEAR(work.net_J, 0.0, 1e-6 * work.put_in_J);
    } else {
      // The lightly damped stiff block dissipates 1.1 % at 2 Hz, the others more.
      EXPECT_GT(work.net_J, 0.005 * work.put_in_J);
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

// After a quarter of an hour in the air only the slowest part of a power law has not relaxed.
TEST_P(EveryBlock, RecoversInFreeAir) {
  const BlockPtr block = GetParam().make_block(), fresh = GetParam().make_block();
  const double deep_m = depth_of_5_N(*block);
  for (int i = 0; i < 2000; ++i) block->step(deep_m, 0.0, 1e-3);
  for (int i = 0; i < 900; ++i) block->step(-1e-3, 0.0, 1.0);
  EXPECT_LT(block->surface_depth_m(), 1e-4);
  fresh->reset(-1e-3);
  EXPECT_NEAR(block->step(0.5 * deep_m, 0.1, 1e-3), fresh->step(0.5 * deep_m, 0.1, 1e-3), 0.02);
}

TEST_P(EveryBlock, InvalidInputChangesNothing) {
  const BlockPtr block = GetParam().make_block();
  const double force_N = block->step(0.004, 0.02, 1e-3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(block->step(nan, 0.0, 1e-3), force_N);
  EXPECT_EQ(block->step(0.004, inf, 1e-3), force_N);
  EXPECT_EQ(block->step(0.004, 0.0, 0.0), force_N);
  EXPECT_EQ(block->step(0.004, 0.0, -1.0), force_N);
  EXPECT_EQ(block->step(0.004, 0.0, nan), force_N);
  EXPECT_EQ(block->surface_depth_m(), 0.004);
}

TEST_P(EveryBlock, ResetClearsTheState) {
  const BlockPtr used = GetParam().make_block(), fresh = GetParam().make_block();
  for (int i = 0; i < 100; ++i) used->step(0.008, 0.1, 1e-3);
  used->reset();
  for (int i = 1; i < 100; ++i) {
    EXPECT_EQ(used->step(1e-4 * i, 0.1, 1e-3), fresh->step(1e-4 * i, 0.1, 1e-3));
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

TEST(Material, UnknownNameIsRefusedWithTheKnownOnes) {
  const std::string message = find_material("jelly").error().message;
  EXPECT_TRUE(test::has_parts(message, {"jelly"}));
  for (const Material& material : materials()) EXPECT_TRUE(test::has_parts(message, {std::string(material.name)}));
}

TEST(Material, HeldForceRisesWithDepthForEveryMaterial) {
  for (const Material& material : materials()) {
    const auto block = material.make_block();
    EXPECT_EQ(block->half_relaxed_force_N(0.0), 0.0) << material.name;
    const double step_m = 2e-4;
    for (double depth_m = 0.0; depth_m < 0.5; depth_m += step_m) {  // beyond where a sphere's stretch ends
      SCOPED_TRACE(std::string(material.name) + " at " + std::to_string(depth_m));
      ASSERT_LT(block->half_relaxed_force_N(depth_m), block->half_relaxed_force_N(depth_m + step_m));
    }
  }
}

}  // namespace
}  // namespace palpate
