#include "rendering/picture/resolution.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

void run(Resolution& resolution, double busy_s, int frames) {
  for (int i = 0; i < frames; ++i) resolution.add(busy_s);
}

TEST(Resolution, FallsWhileFramesAreLateAndNeverBelowItsLeast) {
  Resolution resolution;
  run(resolution, 0.020, 70);
  EXPECT_LT(resolution.scale(), 1.0F);
  run(resolution, 0.050, 1000);
  EXPECT_EQ(resolution.scale(), Resolution::kLeast);
}

TEST(Resolution, OneLongFrameIsNoReason) {
  Resolution resolution;
  run(resolution, 0.012, 30);
  resolution.add(3.0);
  run(resolution, 0.012, 100);
  EXPECT_EQ(resolution.scale(), 1.0F);
}

TEST(Resolution, RisesAgainOnlyWhereThereIsRoomForIt) {
  Resolution resolution;
  run(resolution, 0.050, 200);
  run(resolution, 0.014, 3000);
  EXPECT_EQ(resolution.scale(), Resolution::kLeast) << "with half as many pixels again it would be late";
  run(resolution, 0.006, 3000);
  EXPECT_EQ(resolution.scale(), 1.0F);
}

TEST(Resolution, IsReducedOnlyWhereTheRendererIsAProgram) {
  EXPECT_TRUE(is_software("llvmpipe (LLVM 15.0.6, 256 bits)"));
  EXPECT_TRUE(is_software("softpipe"));
  EXPECT_FALSE(is_software("Mesa Intel(R) UHD Graphics 620 (KBL GT2)"));
  EXPECT_FALSE(is_software("NVIDIA GeForce RTX 3060/PCIe/SSE2"));
}

}  // namespace
}  // namespace palpate
