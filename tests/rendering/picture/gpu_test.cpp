#include "rendering/picture/gpu.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace palpate {
namespace {

constexpr float kRadius_m = 0.005F;

// Sneddon (1965): the depth of a rigid sphere with the contact radius a, exact for a half-space.
double sneddon_depth_m(double a, double radius) { return 0.5 * a * std::log((radius + a) / (radius - a)); }

TEST(Dent, AShallowOneIsHertzs) {
  for (const float depth_m : {1e-6F, 1e-5F, 1e-4F}) {
    const DentShape dent = dent_under_ball(depth_m, kRadius_m);
    EXPECT_NEAR(dent.contact_m, std::sqrt(kRadius_m * depth_m), 0.02F * dent.contact_m) << depth_m;
    EXPECT_NEAR(dent.edge_m, 0.5F * depth_m, 0.02F * depth_m) << depth_m;
  }
}

TEST(Dent, ADeepOneIsNearlySneddons) {
  for (const double share : {0.2, 0.4, 0.6, 0.8, 0.9, 0.95}) {
    const double a = share * static_cast<double>(kRadius_m);
    const auto depth_m = static_cast<float>(sneddon_depth_m(a, static_cast<double>(kRadius_m)));
    EXPECT_NEAR(static_cast<double>(dent_under_ball(depth_m, kRadius_m).contact_m), a, 0.03 * a) << share;
  }
}

TEST(Dent, TheBallAndTheSurfaceBesideItMeetWithTheSameSlope) {
  for (const float depth_m : {1e-5F, 1e-3F, 5e-3F, 2e-2F}) {
    const DentShape dent = dent_under_ball(depth_m, kRadius_m);
    const float q = std::sqrt(kRadius_m * kRadius_m - dent.contact_m * dent.contact_m);
    EXPECT_NEAR(dent.contact_m / q, 2.0F * dent.edge_m / dent.contact_m, 0.02F * dent.contact_m / q) << depth_m;
    EXPECT_LE(dent.contact_m, kRadius_m);
    EXPECT_LT(dent.edge_m, dent.depth_m);
  }
}

}  // namespace
}  // namespace palpate
