#include "scenes/material/material.h"

#include <gtest/gtest.h>

#include "tests/support/message_parts.h"

namespace palpate {
namespace {

TEST(Material, UnknownNameIsRefusedWithTheKnownOnes) {
  const std::string message = find_material("jelly").error().message;
  EXPECT_TRUE(test::has_parts(message, {"jelly"}));
  for (const Material& material : materials()) EXPECT_TRUE(test::has_parts(message, {std::string(material.name)}));
}

TEST(Material, HeldForceRisesWithDepthForEveryMaterial) {
  for (const Material& material : materials()) {
    const auto block = material.make_block();
    EXPECT_EQ(block->half_relaxed_force_N(0.0), 0.0) << material.name;
    const double step_m = 2e-4;
    for (double depth_m = 0.0; depth_m < 0.5; depth_m += step_m) {  // beyond where a sphere's stretch ends
      SCOPED_TRACE(std::string(material.name) + " at " + std::to_string(depth_m));
      ASSERT_LT(block->half_relaxed_force_N(depth_m), block->half_relaxed_force_N(depth_m + step_m));
    }
  }
}

}  // namespace
}  // namespace palpate
