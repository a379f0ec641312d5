// The dent is at the tool while the model pushes it, and recovers with the model's own relaxation times.
#include "scenes/live/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

constexpr double kTau_s = 0.5;
constexpr double kStep_s = 1e-3;

std::vector<FeatureSpec> with_memory() { return {FeatureSpec{}, FeatureSpec{FeatureKind::lowpass_velocity, kTau_s}}; }

// A surface that is deeper than the tool cannot push it. Models of a material without memory have relaxation features
// too, if the plan asks for them.
TEST(Dent, IsAtTheToolWhileTheModelPushes) {
  Dent dent(with_memory());
  for (const double depth_m : {1e-3, 4e-3, 8e-3, 5e-3, 1e-3, 1e-4, 0.0}) {
    dent.step(depth_m, 0.5, 0.0, kStep_s);
    EXPECT_EQ(dent.depth_m(), depth_m);
  }
  dent.step(0.0, 0.0, 0.0, kStep_s);
  EXPECT_EQ(dent.depth_m(), 0.0) << "no trace";
}

TEST(Dent, RecoversFromWhereTheForceEnds) {
  Dent dent(with_memory());
  for (const double depth_m : {4e-3, 8e-3, 2e-3}) dent.step(depth_m, 0.5, 0.0, kStep_s);
  constexpr int kSteps = 500;
  for (int i = 0; i < kSteps; ++i) dent.step(0.0, 0.0, 0.0, kStep_s);
  EXPECT_NEAR(dent.depth_m(), 2e-3 * std::exp(-kSteps * kStep_s / kTau_s), 1e-12);
}

TEST(Dent, APressIntoADentMovesOnlyWhatTheToolReaches) {
  Dent dent(with_memory());
  dent.step(2e-3, 0.5, 0.0, kStep_s);
  dent.step(1e-3, 0.0, 0.0, 0.0);
  EXPECT_EQ(dent.depth_m(), 2e-3) << "the tool is above the surface";
  dent.step(3e-3, 0.0, 0.0, 0.0);
  EXPECT_EQ(dent.depth_m(), 3e-3);
  dent.step(1e-3, std::nan(""), 0.0, 0.0);
  EXPECT_EQ(dent.depth_m(), 2e-3) << "a force that is not known is none";
}

// The branches of a spectrum, as in models of the standard fit, have the same times.
TEST(Dent, RecoversWithTheTimesOfASpectrum) {
  FeatureSpec spectrum{FeatureKind::maxwell_spectrum};
  spectrum.part_count = 1;
  spectrum.parts[0].relaxation_time_s = kTau_s;
  Dent dent({FeatureSpec{}, spectrum});
  Dent low_pass(with_memory());
  for (int i = 0; i < 2000; ++i) {
    const double depth_m = i < 1000 ? 4e-3 : 0.0;
    for (Dent* one : {&dent, &low_pass}) one->step(depth_m, i < 1000 ? 1.0 : 0.0, 0.0, kStep_s);
    ASSERT_EQ(dent.depth_m(), low_pass.depth_m()) << i;
  }
  EXPECT_GT(dent.depth_m(), 1e-5);
}

TEST(Dent, ColourFadesWithinAThirdOfASecond) {
  Dent dent;
  dent.step(1e-3, 1.0, 2.0, kStep_s);
  dent.step(1e-3, 1.0, 0.5, 0.3);
  EXPECT_NEAR(dent.error_over_jnd(), 2.0 / std::exp(1.0), 1e-12);
  dent.step(1e-3, 1.0, 1.5, kStep_s);
  EXPECT_EQ(dent.error_over_jnd(), 1.5);
}

}  // namespace
}  // namespace palpate
