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

struct Fonts {
  ImFont* body = nullptr;
  ImFont* heading = nullptr;
  ImFont* big = nullptr;
};

// The font file that is used; empty: none was found, and a plain built-in one is.
std::string find_font();

class UiStyle {
 public:
  // Before each frame. `height_px`: of the framebuffer. Rebuilds the fonts when the
  // scale has changed; sets all colours when the theme has.
  void update(int height_px, float content_scale, bool large, Theme theme);

  const Fonts& fonts() const noexcept { return fonts_; }
  // Pixels for one pixel of the 1080-line design.
  float scale() const noexcept { return scale_; }
  Theme theme() const noexcept { return theme_; }
  const Palette& colours() const noexcept { return palette(theme_); }

 private:
  void build_fonts();
  void set_colours();

  Fonts fonts_;
  float scale_ = 0.0F;
  Theme theme_ = Theme::light;
  bool coloured_ = false;
};

}  // namespace palpate
