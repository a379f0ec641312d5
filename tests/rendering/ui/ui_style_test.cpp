#include "rendering/ui/ui_style.h"

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>  // after epoxy
#include <gtest/gtest.h>

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

TEST(UiContext, DrawsAgainWhatWasDrawnOver) {
  ASSERT_FALSE(test::virtual_display().empty()) << "Xvfb does not start; apt-get install xvfb";
  ASSERT_EQ(glfwInit(), GLFW_TRUE);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  GLFWwindow* window = glfwCreateWindow(kWidth, kHeight, "widgets", nullptr, nullptr);
  ASSERT_NE(window, nullptr);
  glfwMakeContextCurrent(window);
  {
    UiContext ui(window);
    ui.begin_frame();
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddText({12.0F, 20.0F}, ink(Rgb(1.0F)), "of the model");
    list.AddCircleFilled({200.0F, 120.0F}, 40.0F, ink(Rgb(1.0F, 0.0F, 0.0F), 0.5F));
    list.PushClipRect({0.0F, 150.0F}, {100.0F, 200.0F});
    list.AddRectFilled({20.0F, 100.0F}, {300.0F, 230.0F}, ink(Rgb(0.0F, 1.0F, 0.0F)));
    list.PopClipRect();
    clear({0, 0, kWidth, kHeight});
    const std::vector<unsigned char> empty = pixels();
    ui.end_frame();
    const std::vector<unsigned char> drawn = pixels();
    ASSERT_NE(drawn, empty);
    // Parts with all, some and none of the widgets, and one that is partly outside.
    const Viewport lower{0, 0, 120, 100}, middle{150, 70, 60, 60}, none{280, 200, 30, 30}, outside{-20, 190, 90, 90};
    for (const std::vector<Viewport>& parts :
         {std::vector{lower}, {middle}, {none}, {outside}, {lower, middle, none, outside}, {}}) {
      for (const Viewport& part : parts) clear(part);
      ui.draw_again(parts);
      EXPECT_EQ(pixels(), drawn) << parts.size();
    }
  }
  glfwDestroyWindow(window);
  glfwTerminate();
}

}  // namespace
}  // namespace palpate
