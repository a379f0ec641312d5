// A trend is passive: from rest on, in any motion, it never returns more energy than was put
// in. The trends are fitted to materials with friction, a continuous spectrum, a layer and a
// fluid, so that stops and creep are among their features. Motions are random and exact (no sensor).
//
// Why it holds. The elastic part is a spring, and the viscosity is never negative. A branch z
// driven by a rising curve g(d) stores the integral of (g^-1(g - z + s) - g^-1(g - z)) over
// s from 0 to z and dissipates the rest. Stops with g >= 0 are bristles that bend and slip.
// Nonnegative coefficients make all curves rise.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "engine/base/random_stream.h"
#include "tests/support/fitting.h"

namespace palpate::test {
namespace {

constexpr double kRate_Hz = 4000.0;
constexpr double kSeconds = 15.0;
// The trapezoidal rule at 4 kHz on motions of at most 12 Hz: the error of a cycle is about
// (w h)^2 / 12 = 3e-5 of the energy put in.
constexpr double kIntegration = 1e-4;

// Sines of random frequencies, amplitudes and phases about a mean depth: slow
// presses with tremor, pokes, small cycles at depth, and time in the air.
class RandomMotion {
 public:
  RandomMotion(std::uint64_t seed, double deepest_m) {
    RandomStream random(seed, 5);
    const auto uniform = [&] { return static_cast<double>(random.index(1U << 20)) / (1U << 20); };
    middle_m_ = deepest_m * (0.7 * uniform() - 0.1);
    for (Sine& sine : sines_) {
      const double rate_Hz = 0.1 * std::pow(120.0, uniform());
      sine = {deepest_m * 0.5 * uniform() / (1.0 + rate_Hz), 2.0 * std::numbers::pi * rate_Hz,
              2.0 * std::numbers::pi * uniform()};
    }
  }

  MotionEstimate at(double time_s) const {
    constexpr double kStep_s = 1e-6;  // of the central difference
    return {position_m(time_s), (position_m(time_s + kStep_s) - position_m(time_s - kStep_s)) / (2.0 * kStep_s)};
  }

 private:
  struct Sine {
    double amplitude_m = 0.0, rate_rad_per_s = 0.0, phase = 0.0;
  };

  // Starts in the air and enters within half a second.
  double position_m(double time_s) const {
    double inside_m = middle_m_ - kAir_m;
    for (const Sine& sine : sines_) inside_m += sine.amplitude_m * std::sin(sine.rate_rad_per_s * time_s + sine.phase);
    return kAir_m + std::clamp(2.0 * time_s, 0.0, 1.0) * inside_m;
  }

  static constexpr double kAir_m = -1e-3;
  std::array<Sine, 6> sines_{};
  double middle_m_ = 0.0;
};

struct Balance {
  double put_in_J = 0.0;
  double lowest_J = 0.0;  // the minimum over time of energy put in minus energy returned
};

Balance balance_of(const ForceModel& model, const RandomMotion& motion) {
  FeatureFilter filter(model.features());
  Balance balance;
  double sum_J = 0.0, before_N = 0.0, before_m = 0.0;
  const int count = static_cast<int>(kSeconds * kRate_Hz);
  for (int i = 0; i < count; ++i) {
    const double time_s = i / kRate_Hz;
    const MotionEstimate now = motion.at(time_s);
    const FeatureVector& vector = filter.update({time_s, now.position_m, 0.0, 0.0}, now);
    const double force_N = vector.in_contact ? model.evaluate(vector.values.data()).force_N : 0.0;
    const double work_J = 0.5 * (force_N + before_N) * (now.position_m - before_m);
    if (i > 0) {
      sum_J += work_J;
      balance.put_in_J += std::max(0.0, work_J);
      balance.lowest_J = std::min(balance.lowest_J, sum_J);
    }
    before_N = force_N;
    before_m = now.position_m;
  }
  return balance;
}

ModelPtr trend_of(const std::string& material) {
  RigSettings settings = train_settings(material);
  settings.seconds = 15.0;
  settings.rate_Hz = 250.0;
  return fit(prepare({rig_recording(settings)}, default_request("silicone_block")), &kTrendMethod);
}

TEST(TrendEnergy, NoMotionFromRestEverGetsOutMoreThanWasPutIn) {
  unsigned kinds = 0;
  for (const char* material : {"silicone", "friction", "sponge", "layered", "foam"}) {
    const ModelPtr trend = trend_of(material);
    double worst = 0.0;
    for (const FeatureSpec& spec : trend->features()) kinds |= 1U << static_cast<unsigned>(spec.kind);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Balance balance = balance_of(*trend, RandomMotion(seed, 1.2 * trend->data().trend.reference_depth_m));
      if (!(balance.put_in_J > 0.0)) continue;
      worst = std::min(worst, balance.lowest_J / balance.put_in_J);
      EXPECT_GE(balance.lowest_J, -kIntegration * balance.put_in_J) << material << ", motion " << seed;
    }
    std::printf("energy, trend of %s: at the lowest %.1e of what was put in\n", material, worst);
  }
  for (const FeatureKind kind : {FeatureKind::stops, FeatureKind::creep}) {
    EXPECT_NE(kinds & (1U << static_cast<unsigned>(kind)), 0U) << facts_of(kind).name << " was never chosen";
  }
}

}  // namespace
}  // namespace palpate::test
