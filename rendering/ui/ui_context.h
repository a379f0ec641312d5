// Dear ImGui in a window: its context, and the parts of the window that it has to draw.
// Thread guarantee: the window's thread.
#pragma once

#include <imgui.h>

#include <cstdint>
#include <vector>

#include "rendering/ui/viewport.h"

struct GLFWwindow;

namespace palpate {

class UiContext {
 public:
  // Set the callbacks of the window before: ImGui installs its own, which first call those.
  explicit UiContext(GLFWwindow* window);
  UiContext(const UiContext&) = delete;
  UiContext& operator=(const UiContext&) = delete;
  ~UiContext();

  // `tapped`: keys of GLFW that were pressed and released since the last frame.
  void begin_frame(const std::vector<int>& tapped = {});
  // Draws all widgets since `begin_frame`.
  void end_frame();
  // After ImGui::Render: the parts of the window whose widgets differ from those of the last call, and those `also` to
  // be drawn, as rectangles without overlap, in pixels with the origin at the lower left corner. After a change of the
  // window's size that is everything. Most texts stay the same for seconds, and a software renderer needs as long for
  // them as for the picture.
  std::vector<Viewport> changed_parts(const std::vector<Viewport>& also);
  // Draws the widgets of the last frame again where they are in these parts of the window, which were drawn over.
  void draw_again(const std::vector<Viewport>& parts) const;

 private:
  std::vector<std::uint64_t> hashes(const ImDrawData& widgets) const;
  std::vector<Viewport> rectangles(std::vector<bool> changed) const;

  GLFWwindow* window_;
  int width_ = 0, height_ = 0;  // of the window, pixels
  int columns_ = 0, rows_ = 0;
  std::vector<std::uint64_t> tiles_;  // a hash of the triangles in each, by rows, the upper one first
};

}  // namespace palpate
