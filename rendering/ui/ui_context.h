// Dear ImGui on a window, from its first frame to its last.
// Thread guarantee: the window's thread.
#pragma once

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

 private:
  GLFWwindow* window_;
};

}  // namespace palpate
