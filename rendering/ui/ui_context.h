// The context of Dear ImGui for a window.
// Thread guarantee: the window's thread.
#pragma once

#include <vector>

struct GLFWwindow;

namespace palpate {

class UiContext {
 public:
  // Set callbacks of the window before: ImGui calls them after its own.
  explicit UiContext(GLFWwindow* window);
  UiContext(const UiContext&) = delete;
  UiContext& operator=(const UiContext&) = delete;
  ~UiContext();

  // `tapped`: keys of GLFW that were pressed and released since the last frame.
  void begin_frame(const std::vector<int>& tapped = {});
  // Draws all widgets since `begin_frame`.
  void end_frame();

 private:
  GLFWwindow* window_;
};

}  // namespace palpate
