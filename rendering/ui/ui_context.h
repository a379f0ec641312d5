// The context of Dear ImGui for a window.
// Thread guarantee: the window's thread.
#pragma once

struct GLFWwindow;

namespace palpate {

class UiContext {
 public:
  // Set callbacks of the window before: ImGui calls them after its own.
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
