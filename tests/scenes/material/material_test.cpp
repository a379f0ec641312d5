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
    for (double depth_m = 0.0; depth_m < 0.05; depth_m += 1e-4) {
      ASSERT_LT(block->half_relaxed_force_N(depth_m), block->half_relaxed_force_N(depth_m + 1e-4))
          << material.name << " at " << depth_m;
      ASSERT_LT(block->relaxed_force_N(depth_m), block->relaxed_force_N(depth_m + 1e-4))
          << material.name << " at " << depth_m;
    }
  }
}

TEST(Material, StatesItsRelaxationTimes) {
  EXPECT_EQ(find_material("maxwell").value().relaxation_times, "0.17 s, 1.27 s");
  EXPECT_EQ(find_material("silicone").value().relaxation_times, "continuous, 0.001 s to 30 s");
  for (const Material& material : materials()) EXPECT_FALSE(material.relaxation_times.empty()) << material.name;
}

}  // namespace
}  // namespace palpate
