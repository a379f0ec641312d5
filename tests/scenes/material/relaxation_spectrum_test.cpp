#include "scenes/material/relaxation_spectrum.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

// What is left of a step of E by 1 N after `steps` of `h` seconds.
double held_N(RelaxationSpectrum& spectrum, double h, int steps) {
  spectrum.prepare(1e-12);
  spectrum.relax();
  spectrum.settle(1.0);
  spectrum.prepare(h);
  for (int i = 0; i < steps; ++i) spectrum.relax();
  spectrum.prepare(1e-12);
  spectrum.relax();
  return spectrum.memory_N(0.0);
}

// K(t) = c (E1(t / tau2) - E1(t / tau1)), Fung (1993).
TEST(RelaxationSpectrum, BoxRelaxesAsItsExponentialIntegrals) {
  const double c = 0.06, shortest_s = 1e-3, longest_s = 30.0;
  for (const double t : {0.0, 0.01, 0.1, 1.0, 10.0, 60.0}) {
    RelaxationSpectrum spectrum(shortest_s, longest_s, [&](double) { return c; });
    const double expected = t == 0.0 ? c * std::log(longest_s / shortest_s)
                                     : c * (std::expint(-t / shortest_s) - std::expint(-t / longest_s));
    const double step_s = 1e-3;
    // The midpoint rule with a spacing of 0.21 in ln tau.
    EXPECT_NEAR(held_N(spectrum, step_s, static_cast<int>(std::lround(t / step_s))), expected, 1e-3 * c) << t;
  }
}

// dE/dt = 1: M = sum w tau (1 - exp(-t / tau)), whatever the step.
TEST(RelaxationSpectrum, IsExactOnARampAtEveryStep) {
  double forces_N[2];
  const double steps_s[] = {1e-4, 1e-2};
  for (int k = 0; k < 2; ++k) {
    RelaxationSpectrum spectrum(0.01, 1.0, [](double) { return 0.1; });
    spectrum.prepare(steps_s[k]);
    for (int i = 0; i < static_cast<int>(std::lround(0.5 / steps_s[k])); ++i) {
      spectrum.relax();
      spectrum.settle(steps_s[k]);
    }
    spectrum.prepare(1e-12);
    spectrum.relax();
    forces_N[k] = spectrum.memory_N(0.0);
  }
  EXPECT_NEAR(forces_N[0], forces_N[1], 1e-11);
  // Integral of 0.1 (1 - exp(-0.5 / tau)) d tau, by substitution of E2.
  const auto primitive = [](double tau) { return tau - tau * std::exp(-0.5 / tau) - 0.5 * std::expint(-0.5 / tau); };
  EXPECT_NEAR(forces_N[0], 0.1 * (primitive(1.0) - primitive(0.01)), 1e-5);
}

TEST(RelaxationSpectrum, ForgetsToExactlyNothing) {
  RelaxationSpectrum spectrum(1e-3, 1.0, [](double) { return 0.1; });
  EXPECT_GT(held_N(spectrum, 0.1, 1), 0.0);
  spectrum.prepare(0.1);
  for (int i = 0; i < 2000; ++i) spectrum.relax();
  EXPECT_EQ(spectrum.memory_N(0.0), 0.0);
}

}  // namespace
}  // namespace palpate
