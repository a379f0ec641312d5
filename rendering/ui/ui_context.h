// Dear ImGui on a window, from its first frame to its last.
// Thread guarantee: the window's thread.
#pragma once

#include <imgui.h>

struct GLFWwindow;

namespace palpate {

class UiContext {
 public:
  // Callbacks that the window has by now are called as well.
  explicit UiContext(GLFWwindow* window);
  UiContext(const UiContext&) = delete;
  UiContext& operator=(const UiContext&) = delete;
  ~UiContext();

  void begin_frame();
  // Draws all widgets since `begin_frame`.
  void end_frame();
  // Draws the last frame's widgets once more, but for the windows that lie within two
  // corners, of which the picture still has a copy.
  void draw_again(const ImVec2& low, const ImVec2& high) const;

 private:
  GLFWwindow* window_;
};

}  // namespace palpate
