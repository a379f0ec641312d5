// Fonts, sizes and colours of Dear ImGui, scaled with the window.
// Thread guarantee: the window's thread.
#pragma once

#include <imgui.h>

#include <string>

#include "rendering/ui/colours.h"

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
  // colours when the theme has changed. Returns whether one has.
  bool update(const UiSize& size, float larger, Theme theme, float body_px = kBody_px);

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

}  // namespace palpate
