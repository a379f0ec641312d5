// Closed forms of the springs, dashpots and branches.
#include "scenes/material/maxwell_block.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/base/text.h"
#include "scenes/material/material.h"
#include "tests/support/wandering.h"

namespace palpate {
namespace {

constexpr const MaxwellParameters* kAll[] = {&kMaxwell, &kFoam, &kElastic, &kStiff};

TEST(MaxwellBlock, ItsTimesAreThoseOfTheMaterialsTable) {
  const std::pair<const char*, const MaxwellParameters*> kNamed[] = {
      {"maxwell", &kMaxwell}, {"foam", &kFoam}, {"elastic", &kElastic}, {"stiff", &kStiff}};
  for (const auto& [name, parameters] : kNamed) {
    std::string text;
    for (const RelaxationBranch& branch : parameters->branches) {
      if (branch.stiffness_N_per_m > 0.0)
        text += (text.empty() ? "" : ", ") + shortest(branch.relaxation_time_s) + " s";
    }
    EXPECT_EQ(text.empty() ? "none" : text, find_material(name).value().relaxation_times);
  }
}

TEST(MaxwellBlock, StepHoldRelaxesAsTheSumOfExponentials) {
  for (const MaxwellParameters* material : kAll) {
    MaxwellBlock block(*material);
    const double depth_m = test::depth_of_5_N(block);
    // The step is so short that no branch relaxes: h / tau < 2e-8.
    block.step(depth_m, 0.0, 1e-9);
    const double peak_N = block.force_N();
    for (int tick = 1; tick <= 3000; ++tick) {
      const double force_N = block.step(depth_m, 0.0, 1e-3);
      double expected_N = peak_N;
      for (std::size_t b = 0; b < kMaximumBranches; ++b) {
        const double tau = material->branches[b].relaxation_time_s;
        expected_N += material->unrelaxed_force_N(b, depth_m) * std::expm1(-tick * 1e-3 / tau);
      }
      // In the first step the branches lose a share of up to h / tau of their force.
      ASSERT_NEAR(force_N, expected_N, 1e-6) << depth_m << " tick " << tick;
    }
  }
}

// dF/dt = K v - F / tau from rest: F = K v tau (1 - exp(-t / tau)).
TEST(MaxwellBlock, BranchFollowsTheClosedFormOfARamp) {
  MaxwellParameters material;
  material.elastic_linear_N_per_m = 100.0;
  material.branches[0] = {0.2, 300.0, 0.0};
  MaxwellBlock block(material);
  const double v = 0.01;
  block.step(0.0, v, 1e-3);
  for (int tick = 1; tick <= 500; ++tick) {
    const double t = tick * 1e-3;
    block.step(v * t, v, 1e-3);
    ASSERT_NEAR(block.force_N() - 100.0 * v * t, -300.0 * v * 0.2 * std::expm1(-t / 0.2), 1e-10);
  }
}

TEST(MaxwellBlock, LetsGoOfAToolThatLeavesFasterThanItFollows) {
  for (const MaxwellParameters* material : {&kMaxwell, &kFoam}) {
    MaxwellBlock block(*material);
    const double deep_m = test::depth_of_5_N(block);
    for (int i = 0; i < 3000; ++i) block.step(deep_m, 0.0, 1e-3);
    const double speed = 0.4;
    int apart = 0;
    for (double position_m = deep_m - speed * 1e-3; position_m > 0.0; position_m -= speed * 1e-3) {
      if (block.step(position_m, -speed, 1e-3) == 0.0) {
        ++apart;
        EXPECT_GT(block.surface_depth_m(), position_m);
      }
    }
    EXPECT_GT(apart, 0) << deep_m;
    double last_m = block.surface_depth_m();
    for (int i = 0; i < 1000; ++i) {
      block.step(-1e-3, 0.0, 1e-3);
      ASSERT_LE(block.surface_depth_m(), last_m);
      last_m = block.surface_depth_m();
    }
  }
}

TEST(MaxwellBlock, MeetsTheSurfaceAgainWhereItLags) {
  MaxwellBlock block(kMaxwell);
  for (int i = 0; i < 3000; ++i) block.step(0.012, 0.0, 1e-3);
  block.step(-1e-3, 0.0, 1e-3);
  const double lag_m = block.surface_depth_m();
  ASSERT_GT(lag_m, 1e-3);
  EXPECT_EQ(block.step(0.9 * lag_m, 0.0, 1e-4), 0.0);
  EXPECT_GT(block.step(1.1 * lag_m, 0.0, 1e-4), 0.0);
}

// A motion so slow that branches have no effect: only friction is left.
TEST(MaxwellBlock, FoamHasHysteresisAtRest) {
  MaxwellParameters material = kFoam;
  material.branches = {};
  MaxwellBlock block(material);
  const double deep_m = test::depth_of_5_N(block);
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

}  // namespace
}  // namespace palpate
