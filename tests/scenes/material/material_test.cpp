#include "scenes/material/material.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/base/random_stream.h"
#include "tests/support/rt_guard.h"

namespace palpate {
namespace {

Material named(std::string_view name) {
  const Result<Material> found = find_material(name);
  EXPECT_TRUE(found.ok());
  return found.value();
}

// A smooth wandering motion in and out of the surface, 0 at time 0.
struct Wandering {
  explicit Wandering(std::uint64_t seed, double deepest_m) : random(seed, 7) {
    for (int i = 0; i < 4; ++i) {
      amplitude_m[i] = deepest_m * random.uniform(0.1, 0.4);
      rate_rad_per_s[i] = 6.28 * random.uniform(0.2, i == 3 ? 12.0 : 4.0);
    }
  }
  double position_m(double t) const {
    double sum = 0.0;
    for (int i = 0; i < 4; ++i) sum += amplitude_m[i] * std::sin(rate_rad_per_s[i] * t);
    return sum;
  }
  double velocity_m_per_s(double t) const {
    double sum = 0.0;
    for (int i = 0; i < 4; ++i) {
      sum += amplitude_m[i] * rate_rad_per_s[i] * std::cos(rate_rad_per_s[i] * t);
    }
    return sum;
  }
  RandomStream random;
  double amplitude_m[4];
  double rate_rad_per_s[4];
};

double deepest_m(const Material& material) {
  double depth_m = 0.0;
  while (material.elastic_force_N(depth_m) < 5.0) depth_m += 1e-4;
  return depth_m;
}

TEST(Material, ElasticForceRisesWithDepthForEveryMaterial) {
  for (const Material& material : materials()) {
    for (double depth_m = 0.0; depth_m < 0.05; depth_m += 1e-4) {
      EXPECT_LT(material.elastic_force_N(depth_m), material.elastic_force_N(depth_m + 1e-4))
          << material.name << " at " << depth_m;
    }
  }
}

TEST(Material, UnknownNameIsRefusedWithTheKnownOnes) {
  const Result<Material> found = find_material("jelly");
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(found.error().message,
            "unknown material 'jelly'; known: silicone, foam, elastic, stiff, gel");
}

TEST(Material, StatesItsRelaxationTimes) {
  EXPECT_EQ(relaxation_times_text(named("silicone")), "0.17 s, 1.27 s");
  EXPECT_EQ(relaxation_times_text(named("foam")), "0.08 s, 0.9 s");
  EXPECT_EQ(relaxation_times_text(named("gel")), "0.05 s, 0.4 s, 2.5 s");
  EXPECT_EQ(relaxation_times_text(named("elastic")), "none");
}

TEST(Material, StiffIsThreeKilonewtonsPerMetre) {
  EXPECT_DOUBLE_EQ(named("stiff").elastic_force_N(1e-3), 3.0);
}

TEST(MaterialState, StepHoldRelaxesAsTheSumOfExponentials) {
  for (const Material& material : materials()) {
    MaterialState block(material);
    const double depth_m = deepest_m(material);
    // So short a step that no branch relaxes: h / tau < 2e-8.
    block.step(depth_m, 0.0, 1e-9);
    double start_N[kMaximumBranches] = {};
    for (std::size_t b = 0; b < material.branch_count; ++b) {
      start_N[b] = block.branch_force_N(b);
      EXPECT_NEAR(start_N[b], material.unrelaxed_force_N(b, depth_m), 1e-7) << material.name;
    }
    const double peak_N = block.force_N();
    for (int tick = 1; tick <= 3000; ++tick) {
      const double force_N = block.step(depth_m, 0.0, 1e-3);
      double expected_N = peak_N;
      for (std::size_t b = 0; b < material.branch_count; ++b) {
        const double tau = material.branches[b].relaxation_time_s;
        expected_N += start_N[b] * std::expm1(-tick * 1e-3 / tau);
      }
      // Rounding of 30,000 multiplications by exp(-h / tau).
      ASSERT_NEAR(force_N, expected_N, 1e-10) << material.name << " tick " << tick;
    }
  }
}

// dF/dt = K v - F / tau from rest: F = K v tau (1 - exp(-t / tau)).
TEST(MaterialState, BranchFollowsTheClosedFormOfARamp) {
  Material material;
  material.elastic_linear_N_per_m = 100.0;
  material.branch_count = 1;
  material.branches[0] = {0.2, 300.0, 0.0};
  MaterialState block(material);
  const double v = 0.01;
  block.step(0.0, v, 1e-3);
  for (int tick = 1; tick <= 500; ++tick) {
    const double t = tick * 1e-3;
    block.step(v * t, v, 1e-3);
    ASSERT_NEAR(block.branch_force_N(0), -300.0 * v * 0.2 * std::expm1(-t / 0.2), 1e-10);
  }
}

TEST(MaterialState, OneLongStepEqualsItsSubsteps) {
  for (const Material& material : materials()) {
    MaterialState coarse(material), fine(material);
    coarse.reset(-1e-3);
    fine.reset(-1e-3);
    const double v = 0.05;
    for (int tick = 1; tick <= 100; ++tick) {
      const double from_m = -1e-3 + v * 1e-3 * (tick - 1);
      // The first step starts at rest and bends, so let both take it alike.
      if (tick == 1) {
        coarse.step(from_m, v, 1e-4);
        fine.step(from_m, v, 1e-4);
      }
      const double once_N = coarse.step(from_m + v * 1e-3, v, 1e-3);
      for (int i = 1; i <= 10; ++i) fine.step(from_m + v * 1e-4 * i, v, 1e-4);
      ASSERT_NEAR(once_N, fine.force_N(), 1e-10) << material.name;
    }
  }
}

TEST(MaterialState, ElasticHasNoMemory) {
  const Material material = named("elastic");
  MaterialState block(material);
  RandomStream random(3, 0);
  for (int tick = 0; tick < 2000; ++tick) {
    const double position_m = random.uniform(-0.005, 0.01);
    const double velocity_m_per_s = random.uniform(-0.3, 0.3);
    EXPECT_DOUBLE_EQ(block.step(position_m, velocity_m_per_s, 1e-3),
                     material.elastic_force_N(std::max(0.0, position_m)));
  }
}

// Starting fresh, the work put in is never negative, at no time: what could be
// taken out was put in before.
TEST(MaterialState, NeverGivesMoreEnergyThanItGot) {
  for (const Material& material : materials()) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const Wandering motion(seed, deepest_m(material));
      MaterialState block(material);
      const double dt = 1e-4;
      double work_J = 0.0, last_N = 0.0, last_m = 0.0, put_in_J = 0.0;
      for (int i = 1; i <= 100000; ++i) {
        const double position_m = motion.position_m(i * dt);
        const double force_N = block.step(position_m, motion.velocity_m_per_s(i * dt), dt);
        const double part_J = 0.5 * (force_N + last_N) * (position_m - last_m);
        work_J += part_J;
        put_in_J += std::max(0.0, part_J);
        last_N = force_N;
        last_m = position_m;
        // Trapezoid error: h^2/12 F'' dx is below 1e-5 of the energy that
        // went through.
        ASSERT_GE(work_J, -1e-5 * put_in_J) << material.name << " seed " << seed << " row " << i;
      }
    }
  }
}

TEST(MaterialState, ClosedCycleLosesEnergyUnlessElastic) {
  for (const Material& material : materials()) {
    MaterialState block(material);
    const double deep_m = deepest_m(material), dt = 1e-4;
    for (int cycle = 0; cycle < 3; ++cycle) {
      double work_J = 0.0, put_in_J = 0.0, last_N = 0.0, last_m = 0.0;
      for (int i = 1; i <= 5000; ++i) {
        const double phase = 2.0 * 3.14159265358979 * i / 5000.0;
        const double position_m = 0.5 * deep_m * (1.0 - std::cos(phase));
        const double velocity = 0.5 * deep_m * std::sin(phase) * 2.0 * 3.14159265358979 / 0.5;
        const double force_N = block.step(position_m, velocity, dt);
        const double part_J = 0.5 * (force_N + last_N) * (position_m - last_m);
        work_J += part_J;
        put_in_J += std::max(0.0, part_J);
        last_N = force_N;
        last_m = position_m;
      }
      if (material.name == "elastic") {
        EXPECT_NEAR(work_J, 0.0, 1e-6 * put_in_J);
      } else {
        // The lightly damped stiff block loses 1.1 % at 2 Hz, the others more.
        EXPECT_GT(work_J, 0.005 * put_in_J) << material.name;
      }
    }
  }
}

TEST(MaterialState, NeverPullsAndIsSilentInTheAir) {
  for (const Material& material : materials()) {
    const Wandering motion(11, 1.5 * deepest_m(material));
    MaterialState block(material);
    for (int i = 1; i <= 20000; ++i) {
      const double position_m = motion.position_m(i * 1e-3);
      const double force_N = block.step(position_m, motion.velocity_m_per_s(i * 1e-3), 1e-3);
      ASSERT_GE(force_N, 0.0) << material.name;
      ASSERT_GE(block.surface_depth_m(), std::max(0.0, position_m)) << material.name;
      if (position_m <= 0.0) {
        ASSERT_EQ(force_N, 0.0) << material.name;
      }
    }
  }
}

TEST(MaterialState, LetsGoOfAToolThatLeavesFasterThanItFollows) {
  for (const char* name : {"silicone", "foam", "gel"}) {
    const Material material = named(name);
    MaterialState block(material);
    const double deep_m = deepest_m(material);
    for (int i = 0; i < 3000; ++i) block.step(deep_m, 0.0, 1e-3);
    const double speed = 0.4;
    int apart = 0;
    for (double position_m = deep_m - speed * 1e-3; position_m > 0.0; position_m -= speed * 1e-3) {
      if (block.step(position_m, -speed, 1e-3) == 0.0) {
        ++apart;
        EXPECT_GT(block.surface_depth_m(), position_m) << name;
        EXPECT_FALSE(block.touching()) << name;
      }
    }
    EXPECT_GT(apart, 0) << name;
    double last_m = block.surface_depth_m();
    for (int i = 0; i < 1000; ++i) {
      block.step(-1e-3, 0.0, 1e-3);
      ASSERT_LE(block.surface_depth_m(), last_m) << name;
      last_m = block.surface_depth_m();
    }
  }
}

TEST(MaterialState, MeetsTheSurfaceAgainWhereItLags) {
  MaterialState block(named("gel"));
  for (int i = 0; i < 3000; ++i) block.step(0.012, 0.0, 1e-3);
  block.step(-1e-3, 0.0, 1e-3);
  const double lag_m = block.surface_depth_m();
  ASSERT_GT(lag_m, 1e-3);
  EXPECT_EQ(block.step(0.9 * lag_m, 0.0, 1e-4), 0.0);
  EXPECT_GT(block.step(1.1 * lag_m, 0.0, 1e-4), 0.0);
}

TEST(MaterialState, ForgetsInFreeAir) {
  for (const Material& material : materials()) {
    MaterialState block(material);
    const double deep_m = deepest_m(material);
    for (int i = 0; i < 2000; ++i) block.step(deep_m, 0.0, 1e-3);
    // The surface comes back with tau (1 + K / k), at most 3 tau here.
    for (int i = 0; i < 100000; ++i) block.step(-1e-3, 0.0, 1e-3);
    EXPECT_LT(block.surface_depth_m(), 1e-6) << material.name;
    for (std::size_t b = 0; b < material.branch_count; ++b) {
      EXPECT_LT(std::abs(block.branch_force_N(b)), 1e-3) << material.name;
    }
    MaterialState fresh(material);
    fresh.reset(-1e-3);
    EXPECT_NEAR(block.step(0.5 * deep_m, 0.1, 1e-3), fresh.step(0.5 * deep_m, 0.1, 1e-3), 1e-3);
  }
}

TEST(MaterialState, ResistsMoreGoingInThanComingOut) {
  for (const Material& material : materials()) {
    if (material.name == "elastic") continue;
    MaterialState in(material), still(material), out(material);
    const double depth_m = 0.5 * deepest_m(material);
    for (MaterialState* block : {&in, &still, &out}) {
      for (int i = 0; i < 5000; ++i) block->step(depth_m, 0.0, 1e-3);
    }
    const double still_N = still.step(depth_m, 0.0, 1e-3);
    EXPECT_GT(in.step(depth_m, 0.02, 1e-3), still_N) << material.name;
    EXPECT_LT(out.step(depth_m, -0.02, 1e-3), still_N) << material.name;
  }
}

// Slow enough that no branch matters: what is left is friction.
TEST(MaterialState, FoamHasHysteresisAtRest) {
  Material material = named("foam");
  material.branch_count = 0;
  MaterialState block(material);
  const double deep_m = deepest_m(material);
  double in_N = 0.0, out_N = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    const double force_N = block.step(deep_m * i / 1000.0, 0.0, 1e-2);
    if (i == 700) in_N = force_N;
  }
  for (int i = 1000; i >= 0; --i) {
    const double force_N = block.step(deep_m * i / 1000.0, 0.0, 1e-2);
    if (i == 700) out_N = force_N;
  }
  const double elastic_N = material.elastic_force_N(0.7 * deep_m);
  EXPECT_NEAR(in_N, elastic_N * (1.0 + material.friction_fraction), 1e-9);
  EXPECT_NEAR(out_N, elastic_N * (1.0 - material.friction_fraction), 1e-9);
}

TEST(MaterialState, NonsenseChangesNothing) {
  MaterialState block(named("silicone"));
  const double force_N = block.step(0.004, 0.02, 1e-3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(block.step(nan, 0.0, 1e-3), force_N);
  EXPECT_EQ(block.step(0.004, inf, 1e-3), force_N);
  EXPECT_EQ(block.step(0.004, 0.0, 0.0), force_N);
  EXPECT_EQ(block.step(0.004, 0.0, -1.0), force_N);
  EXPECT_EQ(block.step(0.004, 0.0, nan), force_N);
  EXPECT_EQ(block.surface_depth_m(), 0.004);
}

TEST(MaterialState, ResetForgetsAll) {
  const Material material = named("gel");
  MaterialState used(material), fresh(material);
  for (int i = 0; i < 100; ++i) used.step(0.008, 0.1, 1e-3);
  used.reset();
  for (int i = 1; i < 100; ++i) {
    EXPECT_EQ(used.step(1e-4 * i, 0.1, 1e-3), fresh.step(1e-4 * i, 0.1, 1e-3));
  }
}

TEST(MaterialState, StepNeverAllocatesOrLocks) {
  if (!test::rt_guard_works()) GTEST_SKIP() << "a sanitizer owns malloc";
  for (const Material& material : materials()) {
    const Wandering motion(5, deepest_m(material));
    MaterialState block(material);
    test::RtGuard guard;
    for (int i = 1; i <= 10000; ++i) {
      block.step(motion.position_m(i * 1e-3), motion.velocity_m_per_s(i * 1e-3), 1e-3);
    }
    EXPECT_EQ(guard.stop().total(), 0) << material.name;
  }
}

}  // namespace
}  // namespace palpate
