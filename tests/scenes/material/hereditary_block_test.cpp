#include "scenes/material/hereditary_block.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

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

TEST(HereditaryBlock, ForgetsToExactlyNothing) {
  Straight block(1e-3, 1.0, 0.1);
  block.step(1.0, 0.0, 1e-3);
  EXPECT_GT(block.force_N(), 1.0);
  for (int i = 0; i < 1000; ++i) block.step(1.0, 0.0, 0.1);
  EXPECT_EQ(block.force_N(), 1.0);
}

TEST(SphereContact, IsHertzNearTheSurface) {
  const SphereContact contact{.radius_m = 0.01, .modulus_Pa = 20e3};
  // The next term is 0.2 a / R, here 0.2 %.
  const double depth_m = 1e-6;
  const double hertz_N = 16.0 / 9.0 * 20e3 * std::sqrt(0.01) * depth_m * std::sqrt(depth_m);
  EXPECT_NEAR(contact.force_N(depth_m) / hertz_N, 1.0, 3e-3);
  EXPECT_EQ(contact.force_N(0.0), 0.0);
}

// Lin et al. (2009) give the neo-Hookean force as a quotient of polynomials in a.
TEST(SphereContact, IsThePublishedQuotientWithoutStiffening) {
  const double r = 0.01, modulus_Pa = 30e3;
  const SphereContact contact{.radius_m = r, .modulus_Pa = modulus_Pa};
  for (double depth_m = 1e-4; depth_m < 0.02; depth_m *= 2.0) {
    const double a = std::sqrt(r * depth_m);
    const double quotient = (std::pow(a, 5) - 15.0 * r * std::pow(a, 4) + 75.0 * r * r * std::pow(a, 3)) /
                            (5.0 * r * a * a - 50.0 * r * r * a + 125.0 * r * r * r);
    EXPECT_NEAR(contact.force_N(depth_m) / (80.0 / 27.0 * modulus_Pa * quotient), 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace palpate
