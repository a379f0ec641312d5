// Every colour that has a meaning, once: methods, reference, JND scale, themes.
// Sources: Okabe & Ito (2008) for the methods; the scale ends in a green of viridis
// (van der Walt & Smith 2015, CC0).
// Thread guarantee: pure functions.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <string_view>

namespace palpate {

using Rgb = glm::vec3;  // 0..1, as on the screen (sRGB)

enum class Theme { light, dark };

struct Palette {
  Rgb background;
  Rgb table;
  Rgb panel;
  Rgb raised;  // controls
  Rgb text;
  Rgb quiet;  // second-rank text, axes
  Rgb grid;
  Rgb band;    // the JND band
  Rgb fault;   // red, for nothing else
  Rgb rubber;  // the probe's handle
};
const Palette& palette(Theme theme) noexcept;

// Ratio of luminances as WCAG 2 defines it, 1 to 21.
double contrast(const Rgb& a, const Rgb& b) noexcept;
// What carries a meaning has at least this much against what is behind it (WCAG 2.1, 1.4.11).
inline constexpr double kLeastContrast = 3.0;

// Of a fitting method (scenes/scene/scene.h), lighter or darker where the theme asks for it; one without a hue is
// black or white, and so is what is not known.
Rgb method_colour(std::string_view method, Theme theme);
// Of the `which`-th model of one method, 0 for the first: another shade of it.
Rgb method_colour(std::string_view method, Theme theme, std::size_t which);
// The measured or true force.
inline constexpr Rgb kReferenceColour{0.0F, 0.62F, 0.45F};

// Error over the JND: from 0 to 1 an even scale from nearly white to green, above it
// magenta, which neither the scale nor any block has.
Rgb error_colour(double error_over_jnd) noexcept;
inline constexpr Rgb kAboveJndColour{0.93F, 0.10F, 0.55F};

}  // namespace palpate
