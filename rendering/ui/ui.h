// Dear ImGui in a window: fonts, sizes and colours, scaled with the window; its context, and what is drawn of it.
// Thread guarantee: the window's thread.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "rendering/ui/colours.h"

struct GLFWwindow;

namespace palpate {

inline ImU32 ink(const Rgb& colour, float alpha = 1.0F) {
  return ImGui::ColorConvertFloat4ToU32({colour.r, colour.g, colour.b, alpha});
}
inline ImVec4 paint(const Rgb& colour, float alpha = 1.0F) { return {colour.r, colour.g, colour.b, alpha}; }

// Height of a line, in the window's units. (ImFont::FontSize is in pixels.)
inline float height_of(const ImFont* font) { return font->FontSize * font->Scale; }

// Size of the window and scale factors of the display.
struct UiSize {
  float width = 1280.0F;  // in the window's units
  float height = 720.0F;
  float content_scale = 1.0F;       // scale factor of the display for its contents
  float pixels_per_unit = 1.0F;     // pixels of the framebuffer per unit of the window
  int width_px = 0, height_px = 0;  // of the framebuffer; 0: the window is minimised
};

// Units of the window per pixel of the design, which has 1080 lines, times the factor `larger`. Text has the same
// physical size on displays of different resolution.
float ui_scale(const UiSize& size, float larger) noexcept;
// Text of a smaller scale is not legible.
inline constexpr float kSmallestScale = 0.78F;
// Factor `larger` for exhibits and studies, which are read from a distance.
inline constexpr float kExhibitText = 1.5F;
// Size of body text in a window of 1080 lines; in exhibits it is closer to that of headings.
inline constexpr float kBody_px = 18.0F, kExhibitBody_px = 21.0F;

struct Fonts {
  ImFont* body = nullptr;
  ImFont* heading = nullptr;
  ImFont* big = nullptr;
};

// The font file that is used; empty: none was found, so that the built-in font is used.
std::string find_font();

class UiStyle {
 public:
  // Call it before each frame (UiContext::begin_frame). Rebuilds the fonts when the scale has changed, and sets the
  // colours when the theme has changed.
  void update(const UiSize& size, float larger, Theme theme, float body_px = kBody_px);

  const Fonts& fonts() const noexcept { return fonts_; }
  float scale() const noexcept { return scale_; }  // of ui_scale
  Theme theme() const noexcept { return theme_; }
  const Palette& colours() const noexcept { return palette(theme_); }

 private:
  void build_fonts();
  void set_colours();

  Fonts fonts_;
  float scale_ = 0.0F;  // 0: no fonts yet
  float pixels_per_unit_ = 1.0F, body_px_ = kBody_px;
  Theme theme_ = Theme::light;
};

// A rectangle in pixels of a picture or of the window.
struct Viewport {
  int x = 0, y = 0, width = 0, height = 0;
  bool empty() const noexcept { return width <= 0 || height <= 0; }
  bool operator==(const Viewport&) const = default;
};

// Layers of ImGui windows, by the beginnings of their names: beside the picture; over its parts at rest, with the
// background list; in front of everything. The first two are drawn into pictures of their own and copied, because to
// draw a letter costs a software renderer more.
enum class UiLayer { panel, over_picture, front };
inline constexpr const char* kPanelWindow = "panel";
inline constexpr const char* kOverPicture = "over ";

class UiContext {
 public:
  // Set the callbacks of the window before: ImGui installs its own, which first call those.
  explicit UiContext(GLFWwindow* window);
  UiContext(const UiContext&) = delete;
  UiContext& operator=(const UiContext&) = delete;
  ~UiContext();

  // `tapped`: keys of GLFW that were pressed and released since the last frame.
  void begin_frame(const std::vector<int>& tapped = {});
  // After ImGui::Render, any number of times. Draws a layer into a framebuffer that shows this part of the window, with
  // the upper row first; UiLayer::front into the window itself.
  static void draw_layer(UiLayer layer, const ImVec2& at, const ImVec2& size);
  static void draw_front();

 private:
  GLFWwindow* window_;
};

}  // namespace palpate
