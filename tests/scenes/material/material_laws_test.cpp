// Closed forms of the material laws.
#include "scenes/material/material_laws.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/material/material.h"
#include "tests/support/wandering.h"

namespace palpate {
namespace {

constexpr const MaxwellParameters* kAll[] = {&kMaxwell, &kFoam, &kElastic, &kStiff};

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

// E(s) = 1 N/m s, so that the force is the depth plus the memory.
class Straight final : public HereditaryBlock {
 public:
  Straight(double shortest_s, double longest_s, double weight) : HereditaryBlock({}, shortest_s, longest_s, weight) {
    reset();
  }
  double elastic_force_N(double depth_m) const noexcept override { return depth_m; }
};

// K(t) = c (E1(t / tau2) - E1(t / tau1)), Fung (1993).
TEST(HereditaryBlock, ABoxRelaxesAsItsExponentialIntegrals) {
  const double c = 0.06, shortest_s = 1e-3, longest_s = 30.0;
  for (const double t : {0.0, 0.01, 0.1, 1.0, 10.0, 60.0}) {
    Straight block(shortest_s, longest_s, c);
    double held_N = block.step(1.0, 0.0, 1e-12);
    for (int i = 0; i < static_cast<int>(std::lround(t / 0.01)); ++i) held_N = block.step(1.0, 0.0, 0.01);
    const double expected = t == 0.0 ? c * std::log(longest_s / shortest_s)
                                     : c * (std::expint(-t / shortest_s) - std::expint(-t / longest_s));
    // The tolerance is for the midpoint rule with a spacing of 0.21 in ln tau.
    EXPECT_NEAR(held_N - 1.0, expected, 1e-3 * c) << t;
  }
}

// dE/dt = 1: M = sum w tau (1 - exp(-t / tau)), for any step.
TEST(HereditaryBlock, IsExactOnARampAtEveryStep) {
  double memory_N[2];
  const double steps_s[] = {1e-4, 2e-6};
  for (int k = 0; k < 2; ++k) {
    Straight block(0.01, 1.0, 0.1);
    const int count = static_cast<int>(std::lround(0.5 / steps_s[k]));
    for (int i = 1; i <= count; ++i) memory_N[k] = block.step(i * steps_s[k], 1.0, steps_s[k]) - i * steps_s[k];
  }
  EXPECT_NEAR(memory_N[0], memory_N[1], 1e-11);
  // Integral of 0.1 (1 - exp(-0.5 / tau)) d tau, by substitution of E2.
  const auto primitive = [](double tau) { return tau - tau * std::exp(-0.5 / tau) - 0.5 * std::expint(-0.5 / tau); };
  EXPECT_NEAR(memory_N[0], 0.1 * (primitive(1.0) - primitive(0.01)), 1e-5);
}

TEST(SphereContact, IsHertzNearTheSurface) {
  const SphereContact contact{.radius_m = 0.01, .modulus_Pa = 20e3};
  // The next term is 0.2 a / R, here 0.2 %.
  const double depth_m = 1e-6;
  const double hertz_N = 16.0 / 9.0 * 20e3 * std::sqrt(0.01) * depth_m * std::sqrt(depth_m);
  EXPECT_NEAR(contact.force_N(depth_m) / hertz_N, 1.0, 3e-3);
  EXPECT_EQ(contact.force_N(0.0), 0.0);
}

// Moves at 0.1 mm/s, slowly enough for the spectrum to relax.
void slide(Block& block, double& at_m, double to_m, std::vector<double>* forces_N = nullptr) {
  const int steps = static_cast<int>(std::lround(std::abs(to_m - at_m) / 1e-6));
  const double from_m = at_m;
  for (int i = 1; i <= steps; ++i) {
    at_m = from_m + (to_m - from_m) * i / steps;
    const double force_N = block.step(at_m, 0.0, 1e-2);
    if (forces_N != nullptr) forces_N->push_back(force_N);
  }
}

TEST(FrictionBlock, ReversalFollowsDahlsLaw) {
  FrictionBlock block;
  double at_m = 0.0;
  slide(block, at_m, 6e-3);
  for (int i = 0; i < 60000; ++i) block.step(at_m, 0.0, 1e-3);
  const double before_N = block.force_N();
  EXPECT_NEAR(before_N, FrictionBlock::kContact.force_N(6e-3) + FrictionBlock::kFriction_N, 1e-6)
      << "dry friction does not relax";
  for (const double back_m : {2e-5, 1e-4, 3e-4}) {
    slide(block, at_m, 6e-3 - back_m);
    for (int i = 0; i < 60000; ++i) block.step(at_m, 0.0, 1e-3);
    const double expected_N =
        FrictionBlock::kContact.force_N(at_m) + FrictionBlock::kFriction_N * (2.0 * std::exp(-back_m / 1e-4) - 1.0);
    EXPECT_NEAR(block.force_N(), expected_N, 1e-5) << back_m;
  }
}

// After a long hold it equals two springs in series: k_i (s - g - y)^1.5 = k_s y.
TEST(LayeredBlock, RelaxedIsAContactOnASpring) {
  LayeredBlock block;
  for (int i = 1; i <= 800; ++i) block.step(1e-5 * i, 1e-2, 1e-3);
  for (int i = 0; i < 100000; ++i) block.step(8e-3, 0.0, 1e-3);
  const double inclusion_N = block.force_N() - LayeredBlock::kTop.force_N(8e-3);
  const double y_m = inclusion_N / LayeredBlock::kSupport_N_per_m;
  EXPECT_GT(y_m, 1e-4);
  EXPECT_NEAR(inclusion_N, LayeredBlock::kInclusion_N_per_m1_5 * std::pow(2e-3 - y_m, 1.5), 1e-8);
}

// Forces at every 10 um of a stroke to 6 mm and back.
struct Stroke {
  std::vector<double> in_N, out_N;
};

Stroke stroke(double speed_m_per_s) {
  constexpr int kSteps = 600;
  constexpr double kStep_m = 1e-5;
  ButtonBlock block;
  block.reset(0.0);
  const double dt_s = kStep_m / speed_m_per_s;
  Stroke result;
  for (int i = 1; i <= kSteps; ++i) result.in_N.push_back(block.step(i * kStep_m, speed_m_per_s, dt_s));
  for (int i = kSteps; i > 0; --i) result.out_N.push_back(block.step((i - 1) * kStep_m, -speed_m_per_s, dt_s));
  std::reverse(result.out_N.begin(), result.out_N.end());
  return result;
}

TEST(ButtonBlock, FallsBehindAPeakAndMeetsAFloor) {
  const Stroke slow = stroke(0.002);
  const auto peak = std::max_element(slow.in_N.begin(), slow.in_N.begin() + 250);
  const auto valley = std::min_element(peak, slow.in_N.end());
  EXPECT_NEAR(1e-5 * static_cast<double>(peak - slow.in_N.begin()), 1.4e-3, 0.4e-3);
  EXPECT_GT(*peak, 1.5 * *valley) << "a click";
  EXPECT_GT(*valley, 0.0) << "it comes back by itself";
  EXPECT_GT(slow.in_N.back(), 2.0 * *peak);
}

constexpr double kArea_m2 = 3.14159265358979324 * SpongeBlock::kRadius_m * SpongeBlock::kRadius_m;

// The mean pressure of a disc that drains at its rim, from a uniform pressure p0:
// p0 sum 4 / j_n^2 exp(-j_n^2 D t / a^2), with j_n the zeros of J0.
double drained_share(double t, double diffusivity_m2_per_s) {
  double sum = 0.0;
  for (int n = 1; n <= 200; ++n) {
    // McMahon's expansion, accurate to 1e-4 from the first zero on.
    const double b = (n - 0.25) * 3.14159265358979324;
    const double j = b + 1.0 / (8.0 * b) - 124.0 / (3.0 * std::pow(8.0 * b, 3));
    sum +=
        4.0 / (j * j) * std::exp(-j * j * diffusivity_m2_per_s * t / (SpongeBlock::kRadius_m * SpongeBlock::kRadius_m));
  }
  return sum;
}

TEST(SpongeBlock, StepDrainsAsTheBesselSeriesSlowerWhenDeep) {
  for (const double depth_m : {1e-3, 1e-2}) {
    SpongeBlock block;
    block.step(depth_m, 0.0, 1e-9);
    const double at_once_N = block.force_N() - block.relaxed_force_N(depth_m);
    const double strain = depth_m / SpongeBlock::kHeight_m;
    EXPECT_NEAR(at_once_N, kArea_m2 * SpongeBlock::kPore_Pa * strain, 1e-3 * at_once_N);
    const double diffusivity = SpongeBlock::kDiffusivity_m2_per_s * std::exp(-SpongeBlock::kPermeabilityFall * strain);
    for (int tick = 1; tick <= 1000; ++tick) {
      block.step(depth_m, 0.0, 1e-3);
      // Twelve rings are too coarse until the front is wider than one ring; then the error is 1 %.
      if (diffusivity * tick * 1e-3 < 0.015 * SpongeBlock::kRadius_m * SpongeBlock::kRadius_m) continue;
      ASSERT_NEAR((block.force_N() - block.relaxed_force_N(depth_m)) / at_once_N,
                  drained_share(tick * 1e-3, diffusivity), 0.01)
          << tick;
    }
  }
}

}  // namespace
}  // namespace palpate
