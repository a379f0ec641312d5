// All colours with a meaning: methods, reference, error scale, themes.
// Source of the hues of the methods: Okabe & Ito (2008).
// Thread guarantee: pure functions.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <string_view>

namespace palpate {

using Rgb = glm::vec3;  // 0..1, sRGB
// 0xRRGGBB
constexpr Rgb hex(unsigned value) noexcept {
  return {static_cast<float>((value >> 16) & 255U) / 255.0F, static_cast<float>((value >> 8) & 255U) / 255.0F,
          static_cast<float>(value & 255U) / 255.0F};
}

enum class Theme { light, dark };

struct Palette {
  Rgb background, table, panel;
  Rgb raised;  // controls
  Rgb text;
  Rgb quiet;  // secondary text, axes
  Rgb grid;
  Rgb edge;    // outlines of blocks, controls and the band
  Rgb band;    // the JND band
  Rgb fault;   // red, used for faults only
  Rgb rubber;  // the probe's handle
  float glow;  // brightness of the probe in the shade, as a factor
};
const Palette& palette(Theme theme) noexcept;

// Contrast ratio of WCAG 2, 1 to 21.
double contrast(const Rgb& a, const Rgb& b) noexcept;
// Smallest contrast of a colour with a meaning (WCAG 2.1, 1.4.11) and of text (1.4.3) to what is behind it.
inline constexpr double kLeastContrast = 3.0;
inline constexpr double kLeastTextContrast = 4.5;

// The shade of a method's hue (method_rgb in scenes/scene/scene.h) in this theme. Methods without a hue and unknown
// names are black, or white in the dark theme. Above 0, `which` gives another shade for a further model of the method.
Rgb method_colour(std::string_view method, Theme theme, std::size_t which = 0);
// The measured or true force.
Rgb reference_colour(Theme theme) noexcept;
// A shade of any colour in which text can be read.
Rgb text_colour(const Rgb& colour, Theme theme) noexcept;
// The outline of arrows, probe and dent on a block of this colour: nearly black, or nearly white on a dark block.
Rgb outline_on(const Rgb& block) noexcept;

// Error over the JND: a scale from paper-white (0) over yellow to dark red (1), and violet above 1, which neither the
// scale nor any block contains. Green is the truth only.
Rgb error_colour(double error_over_jnd) noexcept;
inline constexpr Rgb kAboveJndColour = hex(0xB14AED);

}  // namespace palpate
