#include "rendering/picture/smooth_target.h"

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

TEST(Smoothing, IsAFilterWhereTheRendererIsAProgram) {
  EXPECT_EQ(smoothing_for("llvmpipe (LLVM 15.0.6, 256 bits)"), Smoothing::filter);
  EXPECT_EQ(smoothing_for("softpipe"), Smoothing::filter);
  EXPECT_EQ(smoothing_for("Mesa Intel(R) UHD Graphics 620 (KBL GT2)"), Smoothing::samples);
  EXPECT_EQ(smoothing_for("NVIDIA GeForce RTX 3060/PCIe/SSE2"), Smoothing::samples);
}

}  // namespace
}  // namespace palpate
