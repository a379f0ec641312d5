// All colours with a meaning: methods, reference, error scale, themes.
// Sources: Okabe & Ito (2008) for the methods; the error scale ends in a green of viridis (van der Walt & Smith 2015,
// CC0).
// Thread guarantee: pure functions.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <string_view>

namespace palpate {

using Rgb = glm::vec3;  // 0..1, sRGB

enum class Theme { light, dark };

struct Palette {
  Rgb background;
  Rgb table;
  Rgb panel;
  Rgb raised;  // controls
  Rgb text;
  Rgb quiet;  // secondary text, axes
  Rgb grid;
  Rgb band;    // the JND band
  Rgb fault;   // red, used for faults only
  Rgb rubber;  // the probe's handle
};
const Palette& palette(Theme theme) noexcept;

// Contrast ratio of WCAG 2, 1 to 21.
double contrast(const Rgb& a, const Rgb& b) noexcept;
// Smallest contrast of a colour with a meaning to its background (WCAG 2.1, 1.4.11).
inline constexpr double kLeastContrast = 3.0;

// The colour of a method (method_rgb in scenes/scene/scene.h), changed as far as the contrast requires. Methods without
// a hue and unknown names are black, or white in the dark theme.
Rgb method_colour(std::string_view method, Theme theme);
// A shade of it for the `which`-th model of the method, from 0.
Rgb method_colour(std::string_view method, Theme theme, std::size_t which);
// The measured or true force.
inline constexpr Rgb kReferenceColour{0.0F, 0.62F, 0.45F};

// Error over the JND: a perceptually uniform scale from nearly white (0) to green (1), and magenta above 1, which
// neither the scale nor any block contains.
Rgb error_colour(double error_over_jnd) noexcept;
inline constexpr Rgb kAboveJndColour{0.93F, 0.10F, 0.55F};

}  // namespace palpate
