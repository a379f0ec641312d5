// The dent is at the tool while the model pushes it, and recovers with the model's own relaxation times.
#include "scenes/live/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

constexpr double kTau_s = 0.5;
constexpr double kStep_s = 1e-3;

std::vector<FeatureSpec> with_memory() { return {FeatureSpec{}, FeatureSpec{FeatureKind::lowpass_velocity, kTau_s}}; }

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

}  // namespace
}  // namespace palpate
