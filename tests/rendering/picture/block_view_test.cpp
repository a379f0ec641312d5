// The pixels of the picture, on a virtual display.
#include "rendering/picture/block_view.h"

#include <epoxy/gl.h>
// Included after epoxy, which declares OpenGL's functions.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "tests/support/virtual_display.h"

namespace palpate {
namespace {

constexpr int kWidth = 360, kHeight = 320;
using Picture = std::vector<unsigned char>;  // RGB

class BlockViewTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_FALSE(test::virtual_display().empty()) << "Xvfb does not start; apt-get install xvfb";
    ASSERT_EQ(glfwInit(), GLFW_TRUE);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    window_ = glfwCreateWindow(kWidth, kHeight, "picture", nullptr, nullptr);
    ASSERT_NE(window_, nullptr);
    glfwMakeContextCurrent(window_);
    const auto scene = load_scene("silicone_block");
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    scene_ = *scene;
  }
  void TearDown() override {
    glfwDestroyWindow(window_);
    glfwTerminate();
  }

  std::unique_ptr<BlockView> view(Smoothing smoothing) {
    auto view = BlockView::create(scene_, smoothing);
    EXPECT_TRUE(view.ok()) << view.error().message;
    return std::move(*view);
  }
  static std::vector<BlockPose> poses(std::size_t count, float depth_m) {
    std::vector<BlockPose> blocks(count);
    for (BlockPose& block : blocks) {
      block.tool_m = depth_m;
      block.dent_m = std::max(0.0F, depth_m);
      block.force_N = 2.0F;
      block.error_over_jnd = 0.5F;
    }
    blocks[0].chosen = true;
    blocks[0].arrow = Rgb(0.8F, 0.4F, 0.0F);
    return blocks;
  }
  static Picture draw(BlockView& view, const std::vector<BlockPose>& blocks, Theme theme = Theme::light,
                      float scale = 1.0F) {
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    view.draw(blocks, {0, 0, kWidth, kHeight}, theme, scale);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    Picture pixels(3 * kWidth * kHeight);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, kWidth, kHeight, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    return pixels;
  }
  // Root mean square of the differences, in 255ths.
  static double difference(const Picture& a, const Picture& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(static_cast<double>(a[i]) - b[i], 2);
    return std::sqrt(sum / static_cast<double>(a.size()));
  }

  GLFWwindow* window_ = nullptr;
  Scene scene_;
};

TEST_F(BlockViewTest, TheEdgeFilterComesCloseToSeveralSamplesAPixel) {
  const auto samples = view(Smoothing::samples), filter = view(Smoothing::filter);
  EXPECT_FALSE(samples->filters_edges());
  EXPECT_TRUE(filter->filters_edges());
  const std::vector<BlockPose> blocks = poses(4, 0.004F);
  for (BlockView* each : {samples.get(), filter.get()}) each->show(4, true);
  const Picture truth = draw(*samples, blocks);
  EXPECT_LT(difference(truth, draw(*filter, blocks)), 3.9) << "without the filter 4.3";
  EXPECT_LT(difference(truth, draw(*filter, blocks, Theme::light, 0.67F)), 7.0);
}

TEST_F(BlockViewTest, WhatStandsStillFollowsCameraThemeAndChoice) {
  const auto used = view(Smoothing::filter);
  const auto fresh_picture = [&](const std::vector<BlockPose>& blocks, Theme theme, const CameraTurn& turn) {
    const auto fresh = view(Smoothing::filter);
    fresh->camera().turn(turn);
    fresh->show(blocks.size(), true);
    return draw(*fresh, blocks, theme);
  };
  std::vector<BlockPose> blocks = poses(2, 0.002F);
  CameraTurn turn;
  Theme theme = Theme::light;
  const auto expect_fresh = [&](const char* what) {
    used->camera().turn(turn);
    used->show(blocks.size(), true);
    EXPECT_EQ(draw(*used, blocks, theme), fresh_picture(blocks, theme, turn)) << what;
  };
  expect_fresh("first");
  blocks[0].tool_m = blocks[0].dent_m = 0.006F;
  expect_fresh("pressed");
  std::swap(blocks[0].chosen, blocks[1].chosen);
  expect_fresh("another one chosen");
  turn.yaw_rad = 0.3F;
  expect_fresh("camera turned");
  theme = Theme::dark;
  expect_fresh("theme");
  blocks = poses(4, 0.002F);
  expect_fresh("more blocks");
}

// Counts the pixels that a small dent changes visibly.
TEST_F(BlockViewTest, ASmallDentIsSeen) {
  for (const Smoothing smoothing : {Smoothing::samples, Smoothing::filter}) {
    const auto one = view(smoothing);
    std::vector<BlockPose> flat = poses(1, 0.001F), pressed = flat;
    flat[0].dent_m = 0.0F;
    for (auto* blocks : {&flat, &pressed}) (*blocks)[0].shows_error = false;
    const Picture a = draw(*one, flat), b = draw(*one, pressed);
    int seen = 0;
    for (std::size_t i = 0; i < a.size(); i += 3) seen += std::abs(a[i] - b[i]) > 6 ? 1 : 0;
    EXPECT_GT(seen, 40) << "of the some 12,000 pixels of the top";
  }
}

TEST(Smoothing, IsAFilterWhereTheRendererIsAProgram) {
  EXPECT_EQ(smoothing_for("llvmpipe (LLVM 15.0.6, 256 bits)"), Smoothing::filter);
  EXPECT_EQ(smoothing_for("softpipe"), Smoothing::filter);
  EXPECT_EQ(smoothing_for("Mesa Intel(R) UHD Graphics 620 (KBL GT2)"), Smoothing::samples);
  EXPECT_EQ(smoothing_for("NVIDIA GeForce RTX 3060/PCIe/SSE2"), Smoothing::samples);
}

}  // namespace
}  // namespace palpate
