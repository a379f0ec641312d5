#include "rendering/app/window.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(Window, KnowsWhetherTheRendererIsAProgram) {
  EXPECT_TRUE(is_software("llvmpipe (LLVM 15.0.6, 256 bits)"));
  EXPECT_TRUE(is_software("softpipe"));
  EXPECT_FALSE(is_software("Mesa Intel(R) UHD Graphics 620 (KBL GT2)"));
  EXPECT_FALSE(is_software("NVIDIA GeForce RTX 3060/PCIe/SSE2"));
}

}  // namespace
}  // namespace palpate
