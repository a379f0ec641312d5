// The pixels of the picture, on a virtual display.
#include "rendering/picture/block_view.h"

#include <epoxy/gl.h>
// Included after epoxy, which declares OpenGL's functions.
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <utility>

#include "models/correction/methods.h"
#include "tests/support/message_parts.h"
#include "tests/support/virtual_display.h"

namespace palpate {
namespace {

constexpr int kWidth = 360, kHeight = 320;
// The picture at 1280x720.
constexpr int kWholeWidth = 768, kWholeHeight = 720;
using Picture = std::vector<unsigned char>;  // RGB

class BlockViewTest : public ::testing::Test {
 protected:
  void SetUp() override {
    window_ = test::open_gl_window(kWholeWidth, kWholeHeight);
    ASSERT_NE(window_, nullptr);
    const Result scene = test::must(load_scene("silicone_block"));
    scene_ = *scene;
  }
  void TearDown() override {
    glfwDestroyWindow(window_);
    glfwTerminate();
  }

  std::unique_ptr<BlockView> view() {
    auto view = BlockView::create(scene_);
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
    blocks[0].arrow = Rgb(0.8F, 0.4F, 0.0F);
    blocks[0].shows_truth = true;
    blocks[0].true_dent_m = 0.5F * blocks[0].dent_m;
    blocks[0].true_force_N = 3.0F;
    return blocks;
  }
  static Picture draw(BlockView& view, const std::vector<BlockPose>& blocks, Theme theme = Theme::light,
                      int width = kWidth, int height = kHeight) {
    view.draw(blocks, {0, 0, width, height}, theme);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    Picture pixels(static_cast<std::size_t>(3 * width * height));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    return pixels;
  }
  static Picture draw_whole(BlockView& view, const std::vector<BlockPose>& blocks, Theme theme) {
    view.show(blocks.size(), {kWholeWidth, kWholeHeight}, true);
    return draw(view, blocks, theme, kWholeWidth, kWholeHeight);
  }
  static Rgb pixel(const Picture& picture, int x, int y_down) {
    const auto at = static_cast<std::size_t>(3 * ((kWholeHeight - 1 - y_down) * kWholeWidth + x));
    return Rgb(picture[at], picture[at + 1], picture[at + 2]) / 255.0F;
  }
  // Of the rows in which the pictures differ, down to the row `last`, the share in which a pixel has sufficient
  // contrast to what is there without the object.
  static double seen_rows(const Picture& with, const Picture& without, int last = kWholeHeight - 1) {
    int rows = 0, seen = 0;
    for (int y = 0; y <= last; ++y) {
      double most = 1.0;
      bool differs = false;
      for (int x = 0; x < kWholeWidth; ++x) {
        const Rgb a = pixel(with, x, y), b = pixel(without, x, y);
        if (a == b) continue;
        differs = true;
        most = std::max(most, contrast(a, b));
      }
      rows += differs ? 1 : 0;
      seen += most >= kLeastContrast ? 1 : 0;
    }
    EXPECT_GT(rows, 10);
    return static_cast<double>(seen) / std::max(rows, 1);
  }
  GLFWwindow* window_ = nullptr;
  Scene scene_;
};

TEST_F(BlockViewTest, EveryChangeGivesThePictureOfAFreshStart) {
  const auto used = view();
  std::vector<BlockPose> blocks = poses(2, 0.002F);
  CameraTurn turn;
  Theme theme = Theme::light;
  const auto expect_fresh = [&](const char* what) {
    const auto fresh = view();
    for (BlockView* each : {used.get(), fresh.get()}) {
      each->camera().turn(turn);
      each->show(blocks.size(), {kWidth, kHeight}, true);
    }
    const Picture kept = draw(*used, blocks, theme);
    EXPECT_EQ(kept, draw(*fresh, blocks, theme)) << what;
  };
  expect_fresh("first");
  blocks[0].tool_m = blocks[0].dent_m = 0.006F;
  expect_fresh("pressed");
  blocks[1].error_over_jnd = 3.0F;
  expect_fresh("a halo");
  blocks[1].error_over_jnd = 0.5F;
  expect_fresh("no halo");
  blocks[0].true_dent_m = 0.001F;
  expect_fresh("another truth");
  turn.yaw_rad = 0.3F;
  expect_fresh("camera turned");
  theme = Theme::dark;
  expect_fresh("theme");
  blocks = poses(5, 0.002F);
  expect_fresh("more blocks");
  used->leave_free(0.0F, 0.0F);
  expect_fresh("nothing");
  for (const float depth_m : {0.009F, -0.03F, 0.0F}) {
    blocks = poses(6, depth_m);
    expect_fresh("in motion");
  }
}

// Equal presses look equal: each block is seen by the same camera.
TEST_F(BlockViewTest, EveryNumberOfBlocksIsOnTheStageAndInTheSamePerspective) {
  const auto each = view();
  each->leave_free(0.15F, 0.2F);
  const glm::vec2 size(kWholeWidth, kWholeHeight);
  for (std::size_t count = 1; count <= BlockView::kMostBlocks; ++count) {
    each->show(count, size, true);
    const auto half = 0.5F * static_cast<float>(scene_.block.width_m);
    const glm::vec2 first = each->on_screen(0, count, glm::vec3(half, 0.0F, 0.0F), size) -
                            each->on_screen(0, count, glm::vec3(-half, 0.0F, 0.0F), size);
    EXPECT_GT(first.x, 0.18F * size.x) << count;
    for (std::size_t i = 0; i < count; ++i) {
      const glm::vec2 left = each->on_screen(i, count, {-half, 0.0F, 0.0F}, size);
      const glm::vec2 right = each->on_screen(i, count, {half, 0.0F, 0.0F}, size);
      EXPECT_LT(glm::length(right - left - first), 0.01F);
      EXPECT_GT(left.x, 0.0F);
      EXPECT_LT(right.x, size.x);
      EXPECT_LT(each->foot(i, count, size).y, 0.8F * size.y);
    }
  }
}

TEST_F(BlockViewTest, EveryPointOfThePictureBelongsToABlock) {
  const auto each = view();
  const glm::vec2 size(kWholeWidth, kWholeHeight);
  for (const bool one_row : {false, true}) {
    each->in_one_row(one_row);
    for (std::size_t count = 1; count <= BlockView::kMostBlocks; ++count) {
      for (std::size_t i = 0; i < count; ++i) {
        for (const float y_m : {0.01F, -0.01F})
          EXPECT_EQ(each->cell_at(each->on_screen(i, count, {0.0F, y_m, 0.0F}, size), count, size), i) << count;
        EXPECT_TRUE(!one_row || each->foot(i, count, size).y == each->foot(0, count, size).y);
      }
      EXPECT_EQ(each->cell_at({-5.0F, -5.0F}, count, size), 0U);
      EXPECT_EQ(each->cell_at(size + 5.0F, count, size), count - 1);
    }
  }
}

// WCAG 2.1, 1.4.11, measured with light and shadow. The rest are rows at the tip of the arrow, at an end of the probe,
// or at a rim, which antialiasing mixes with what is behind.
TEST_F(BlockViewTest, WhatCarriesAMeaningIsSeenInBothThemes) {
  constexpr double kRows = 0.9;
  constexpr float kAway_m = -1.0F, kLifted_m = -0.012F;
  for (const char* name : {"silicone_block", "stiff_block", "foam_block"}) {
    const Result scene = test::must(load_scene(name));
    scene_ = *scene;
    const auto one = view();
    const int middle = static_cast<int>(one->on_screen(0, 1, {0.0F, 0.0F, 0.0F}, {kWholeWidth, kWholeHeight}).y);
    for (const Theme theme : {Theme::light, Theme::dark}) {
      const std::string where = std::string(name) + (theme == Theme::dark ? ", dark" : ", light");
      BlockPose none;
      none.tool_m = kAway_m;
      none.shows_error = false;
      const Picture bare = draw_whole(*one, {none}, theme);
      for (const Method* method : methods()) {
        BlockPose arrow = none;
        arrow.force_N = 4.0F;
        arrow.arrow = method_colour(method->name, theme);
        EXPECT_GE(seen_rows(draw_whole(*one, {arrow}, theme), bare, middle), kRows)
            << where << ", arrow " << method->name;
      }
      BlockPose probe = none;
      probe.tool_m = kLifted_m;
      const int tip = static_cast<int>(one->on_screen(0, 1, {0.0F, -kLifted_m, 0.0F}, {kWholeWidth, kWholeHeight}).y);
      EXPECT_GE(seen_rows(draw_whole(*one, {probe}, theme), bare, tip), kRows) << where << ", probe";
      for (const float error : {0.0F, 0.5F, 1.0F, 2.0F}) {
        BlockPose dent = none, plain;
        dent.dent_m = 0.008F;
        dent.error_over_jnd = error;
        plain = dent;
        dent.shows_error = true;
        EXPECT_GE(seen_rows(draw_whole(*one, {dent}, theme), draw_whole(*one, {plain}, theme)), kRows)
            << where << ", dent of " << error << " JND";
      }
    }
  }
}

// Counts the pixels that a small dent changes visibly.
TEST_F(BlockViewTest, ASmallDentIsSeen) {
  const auto one = view();
  std::vector<BlockPose> flat = poses(1, 0.001F), pressed = flat;
  for (auto* blocks : {&flat, &pressed}) (*blocks)[0].shows_error = (*blocks)[0].shows_truth = false;
  flat[0].dent_m = 0.0F;
  const Picture a = draw_whole(*one, flat, Theme::light), b = draw_whole(*one, pressed, Theme::light);
  int seen = 0;
  for (std::size_t i = 0; i < a.size(); i += 3) seen += std::abs(a[i] - b[i]) > 6 ? 1 : 0;
  EXPECT_GT(seen, 1000) << "of half a million";
}

// The colour of the error fills the cut while the tool presses, and a halo says from afar that it is above one JND.
TEST_F(BlockViewTest, TheErrorFillsTheCutAndGrowsAHaloAboveOneJnd) {
  for (const std::size_t count : {1u, 2u, 5u}) {
    const auto each = view();
    const auto violet = [&](float error) {
      std::vector<BlockPose> blocks = poses(count, 0.008F);
      for (BlockPose& block : blocks) block.error_over_jnd = error;
      const Picture picture = draw_whole(*each, blocks, Theme::light);
      int pixels = 0;
      for (std::size_t i = 0; i < picture.size(); i += 3)
        pixels += picture[i] > 120 && picture[i + 1] < 110 && picture[i + 2] > 140 ? 1 : 0;
      return static_cast<double>(pixels) / kWholeWidth / kWholeHeight;
    };
    EXPECT_LT(violet(0.9F), 1e-3);
    EXPECT_GT(violet(1.1F), 0.04) << count << " blocks: of the whole picture";
    EXPECT_GT(violet(3.0F), violet(1.1F)) << "the halo grows";
  }
}

// A press through the whole dome changes the picture around it, but not the rim of the block.
TEST_F(BlockViewTest, ADomeSnapsThroughOnABlockThatStays) {
  const Result scene = test::must(load_scene("button"));
  scene_ = *scene;
  const auto one = view();
  BlockPose rest;
  rest.tool_m = -1.0F;
  rest.shows_error = false;
  BlockPose pressed = rest;
  pressed.dent_m = 0.012F;
  const Picture a = draw_whole(*one, {rest}, Theme::light), b = draw_whole(*one, {pressed}, Theme::light);
  const auto half = 0.5F * static_cast<float>(scene->block.length_m);
  const auto row = [&](float z) {
    return static_cast<int>(one->on_screen(0, 1, {0.0F, 0.0F, z}, {kWholeWidth, kWholeHeight}).y);
  };
  int at_rim = 0, at_dome = 0;
  for (int y = 0; y < kWholeHeight; ++y) {
    for (int x = 0; x < kWholeWidth; ++x) {
      if (pixel(a, x, y) == pixel(b, x, y)) continue;
      (y < row(-0.95F * half) ? at_rim : at_dome) += 1;
    }
  }
  EXPECT_EQ(at_rim, 0);
  EXPECT_GT(at_dome, 500);
}

TEST(Camera, SeesWhatItFrames) {
  Camera camera;
  camera.frame(0.1F, 0.0F, 0.2F, 0.3F, true);
  const glm::vec2 size(768.0F, 720.0F);
  const glm::mat4 view = camera.view_projection(size.x / size.y);
  for (const glm::vec3 point :
       {glm::vec3(0.09F, 0.0F, 0.0F), glm::vec3(-0.09F, 0.0F, 0.0F), glm::vec3(0.0F, 0.0F, 0.09F)}) {
    const glm::vec2 at = project(view, point, size);
    EXPECT_GT(at.x, 0.0F);
    EXPECT_LT(at.x, size.x);
    EXPECT_GT(at.y, 0.0F);
    EXPECT_LT(at.y, size.y);
  }
  EXPECT_LT(project(view, {0.0F, 0.05F, 0.0F}, size).y, project(view, {0.0F, 0.0F, 0.0F}, size).y) << "up is up";
}

// The blocks are cut open at the front.
TEST(Camera, StaysAboveTheTableBeforeTheCutAndWithinItsDistances) {
  Camera camera;
  camera.frame(0.1F, 0.0F, 0.2F, 0.3F, true);
  for (const auto& [pitch_rad, factor] : {std::pair{-50.0F, 1e-3F}, std::pair{50.0F, 1e3F}}) {
    camera.orbit(pitch_rad, pitch_rad);
    camera.zoom(factor);
    for (int i = 0; i < 300; ++i) camera.advance(0.016F);
    const glm::vec3 eye = camera.eye();
    EXPECT_GT(eye.y, 0.0F);
    EXPECT_GT(eye.z, std::abs(eye.x));
    EXPECT_GT(std::hypot(eye.x, eye.z), 0.1F * eye.y) << "left stays left";
    EXPECT_GE(glm::length(eye), 0.15F);
    EXPECT_LE(glm::length(eye), 1.21F);
  }
}

}  // namespace
}  // namespace palpate
