// Fonts, sizes and colours of the panel, scaled with the window.
// Thread guarantee: the window's thread, between frames.
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

// The window, and how the display wants its contents.
struct UiSize {
  float width = 1280.0F;  // in the window's units
  float height = 720.0F;
  float content_scale = 1.0F;    // of the display: pixels for a pixel of a usual one
  float pixels_per_unit = 1.0F;  // of the framebuffer
};

// Units of the window for one pixel of the 1080-line design: follows the size that the
// window has to the eye, so that a display with twice the pixels shows the same text.
float ui_scale(const UiSize& size, float larger) noexcept;
// How much larger text is for people who stand.
inline constexpr float kExhibitText = 1.5F;

struct Fonts {
  ImFont* body = nullptr;
  ImFont* heading = nullptr;
  ImFont* big = nullptr;
};

// The font file that is used; empty: none was found, and a plain built-in one is.
std::string find_font();

class UiStyle {
 public:
  // Before each frame. Rebuilds the fonts when the scale has changed; sets all colours
  // when the theme has.
  void update(const UiSize& size, float larger, Theme theme);

  const Fonts& fonts() const noexcept { return fonts_; }
  // As ui_scale has it.
  float scale() const noexcept { return scale_; }
  Theme theme() const noexcept { return theme_; }
  const Palette& colours() const noexcept { return palette(theme_); }

 private:
  void build_fonts(float pixels_per_unit);
  void set_colours();

  Fonts fonts_;
  float scale_ = 0.0F;
  float pixels_per_unit_ = 1.0F;
  Theme theme_ = Theme::light;
  bool coloured_ = false;
};

}  // namespace palpate
