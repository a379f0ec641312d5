// The dent follows the model's own relaxation features.
#include "scenes/live/dent.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double kTau_s = 0.5;
constexpr double kStep_s = 1e-3;

std::vector<FeatureSpec> with_memory() { return {FeatureSpec{}, FeatureSpec{FeatureKind::lowpass_velocity, kTau_s}}; }

// m = d - tau y with y the low-pass feature of engine/tick/features.h.
TEST(Dent, IsTheDepthLessTheLowPassedVelocity) {
  Dent dent(with_memory());
  FeatureFilter filter(with_memory());
  for (int i = 0; i < 3000; ++i) {
    ToolSample sample;
    sample.time_s = kStep_s * i;
    sample.position_m = i < 1500 ? 4e-3 * std::sin(2.0 * sample.time_s) : -1e-3;
    const MotionEstimate motion{sample.position_m, 0.0};
    const FeatureVector& features = filter.update(sample, motion);
    const double depth_m = std::max(0.0, sample.position_m);
    dent.step(depth_m, 0.0, i == 0 ? 0.0 : kStep_s);
    const double remembered_m = depth_m - kTau_s * features.values[1];
    // Within a step the feature assumes a linear depth, the dent a constant one.
    ASSERT_NEAR(dent.depth_m(), std::max(depth_m, 0.35 * remembered_m), 1e-5) << i;
  }
  EXPECT_GT(dent.depth_m(), 1e-6) << "still on its way back";
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
    for (Dent* one : {&dent, &low_pass}) one->step(depth_m, 0.0, kStep_s);
    ASSERT_EQ(dent.depth_m(), low_pass.depth_m()) << i;
  }
  EXPECT_GT(dent.depth_m(), 1e-5);
}

TEST(Dent, ColourFadesWithinAThirdOfASecond) {
  Dent dent;
  dent.step(1e-3, 2.0, kStep_s);
  dent.step(1e-3, 0.5, 0.3);
  EXPECT_NEAR(dent.error_over_jnd(), 2.0 / std::exp(1.0), 1e-12);
  dent.step(1e-3, 1.5, kStep_s);
  EXPECT_EQ(dent.error_over_jnd(), 1.5);
}

}  // namespace
}  // namespace palpate
