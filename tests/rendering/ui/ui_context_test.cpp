#include "rendering/ui/ui.h"

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>  // after epoxy
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/support/virtual_display.h"

namespace palpate {
namespace {

constexpr int kWidth = 320, kHeight = 240;

std::vector<unsigned char> pixels() {
  std::vector<unsigned char> rgb(3 * kWidth * kHeight);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, kWidth, kHeight, GL_RGB, GL_UNSIGNED_BYTE, rgb.data());
  return rgb;
}

void clear(const Viewport& part) {
  glEnable(GL_SCISSOR_TEST);
  glScissor(part.x, part.y, part.width, part.height);
  glClearColor(0.2F, 0.3F, 0.4F, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT);
  glDisable(GL_SCISSOR_TEST);
}

class UiContextTest : public testing::Test {
 protected:
  void SetUp() override {
    window_ = test::open_gl_window(kWidth, kHeight);
    ASSERT_NE(window_, nullptr);
    ui_ = std::make_unique<UiContext>(window_);
  }
  void TearDown() override {
    ui_.reset();
    if (window_ != nullptr) glfwDestroyWindow(window_);
    glfwTerminate();
  }
  // Widgets with limits between pixels, of which some move with `step`.
  void add_widgets(int step) {
    ui_->begin_frame();
    const auto moved = static_cast<float>(step);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddText({12.0F, 20.0F}, ink(Rgb(1.0F)), "of the model");
    list.AddText({150.3F, 20.4F}, ink(Rgb(1.0F)), std::to_string(step / 2).c_str());
    list.AddCircleFilled({200.0F + 3.0F * moved, 120.0F}, 40.0F, ink(Rgb(1.0F, 0.0F, 0.0F), 0.5F));
    list.PushClipRect({0.7F, 150.6F}, {100.2F, 200.3F});
    list.AddRectFilled({20.0F, 100.0F + moved}, {300.0F, 230.0F}, ink(Rgb(0.0F, 1.0F, 0.0F)));
    list.PopClipRect();
    if (step == 5) list.AddRectFilled({5.0F, 5.0F}, {60.0F, 60.0F}, ink(Rgb(0.0F), 0.5F));
  }

  GLFWwindow* window_ = nullptr;
  std::unique_ptr<UiContext> ui_;
};

TEST_F(UiContextTest, DrawsAgainWhatWasDrawnOver) {
  add_widgets(0);
  clear({0, 0, kWidth, kHeight});
  const std::vector<unsigned char> empty = pixels();
  ui_->end_frame();
  const std::vector<unsigned char> drawn = pixels();
  ASSERT_NE(drawn, empty);
  // Parts with all, some and none of the widgets, one that is partly outside, and neighbours.
  const Viewport lower{0, 0, 120, 100}, middle{150, 70, 60, 60}, none{280, 200, 30, 30}, outside{-20, 190, 90, 90};
  for (const std::vector<Viewport>& parts : {std::vector{lower},
                                             {middle},
                                             {none},
                                             {outside},
                                             {lower, middle, none, outside},
                                             {{0, 0, 64, 64}, {64, 0, 64, 64}, {0, 64, 128, 32}},
                                             {}}) {
    for (const Viewport& part : parts) clear(part);
    ui_->draw_again(parts);
    EXPECT_EQ(pixels(), drawn) << parts.size();
  }
}

TEST_F(UiContextTest, ChangedPartsAreAllThatHasToBeDrawn) {
  const Viewport whole{0, 0, kWidth, kHeight};
  for (int step = 0; step < 8; ++step) {
    add_widgets(step);
    ImGui::Render();
    const std::vector<unsigned char> before = pixels();
    const std::vector<Viewport> parts = ui_->changed_parts({});
    int area = 0;
    for (const Viewport& part : parts) {
      area += part.width * part.height;
      clear(part);
    }
    ui_->draw_again(parts);
    const std::vector<unsigned char> in_parts = pixels();
    clear(whole);
    ui_->draw_again({whole});
    EXPECT_EQ(in_parts, pixels()) << "step " << step;
    if (step == 0) {
      EXPECT_EQ(parts, std::vector{whole}) << "the first frame";
    } else {
      EXPECT_NE(in_parts, before);
      EXPECT_LT(area, kWidth * kHeight / 2) << "step " << step;
    }
  }
  EXPECT_TRUE(ui_->changed_parts({}).empty()) << "nothing has changed";
  const Viewport asked{40, 40, 10, 10}, beyond{kWidth - 4, -8, 40, 20};
  const std::vector<Viewport> found = ui_->changed_parts({asked, beyond});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(common_part(found[0], asked), asked);
  EXPECT_FALSE(common_part(found[1], beyond).empty());
}

}  // namespace
}  // namespace palpate
