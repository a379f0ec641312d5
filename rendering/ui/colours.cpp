#include "rendering/ui/colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <vector>

#include "scenes/scene/scene.h"

namespace palpate {
namespace {

const Palette kLight{hex(0xF3F3F2), hex(0xE9E8E6), hex(0xFFFFFF), hex(0xECEEF1), hex(0x16191D), hex(0x5C6670),
                     hex(0xDDE1E5), hex(0x78818A), hex(0xE9ECEF), hex(0xC4161C), hex(0x44494F), 0.34F};
const Palette kDark{hex(0x131516), hex(0x222426), hex(0x1B1F23), hex(0x2D343B), hex(0xF1F3F5), hex(0xA3ADB7),
                    hex(0x333A41), hex(0x7C8590), hex(0x2C333A), hex(0xFF5A4F), hex(0x8A929A), 0.70F};
constexpr Rgb kDarkOutline = hex(0x17191C), kLightOutline = hex(0xFFFFFF);

// The hues of the methods and of the truth, and their shades in either theme: those nearest to them with which every
// pair differs by at least 20 (CIE 1976), for deuteranopes and protanopes too (Machado et al. 2009), and which have the
// contrast below (colours_test.cpp).
struct Shades {
  std::uint32_t hue, light, dark;
};
constexpr std::uint32_t kReference = 0x009E73;
constexpr std::array<Shades, 6> kShadesOfHues{{{0x56B4E9, 0x0787B9, 0x73BBE8},
                                               {0xE69F00, 0xBE6C0A, 0xEFA714},
                                               {0x0072B2, 0x094871, 0x158FDB},
                                               {0xD55E00, 0x843700, 0xD25B00},
                                               {0xCC79A7, 0x5E263C, 0xAE74A2},
                                               {kReference, 0x228E6A, 0x19A67B}}};

// From paper-white over yellow to dark red, in equal steps of lightness (CIELAB L* 97, 79, 60, 42, 24).
constexpr std::array<Rgb, 5> kScale{hex(0xFBF7EA), hex(0xF3BE3C), hex(0xD9772B), hex(0xA83E1E), hex(0x6F0F14)};

double luminance(const Rgb& colour) noexcept {
  const auto linear = [](float value) {
    return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F);
  };
  return 0.2126F * linear(colour.r) + 0.7152F * linear(colour.g) + 0.0722F * linear(colour.b);
}

// Mixes the colour with `end` until its contrast to all surfaces is at least `least`. Drawing asks for the same few
// colours several hundred times a frame, so the results are kept.
Rgb mixed_until(const Rgb& colour, const Rgb& end, double least, Theme theme) noexcept {
  struct Mixed {
    Rgb colour, end;
    double least;
    Theme theme;
    Rgb result;
  };
  thread_local std::vector<Mixed> known;
  const auto found = std::ranges::find_if(known, [&](const Mixed& one) {
    return one.colour == colour && one.end == end && one.least == least && one.theme == theme;
  });
  if (found != known.end()) return found->result;
  constexpr float kStep = 0.02F;
  const Palette& p = palette(theme);
  const auto enough = [&](const Rgb& shade) {
    return std::min({contrast(shade, p.panel), contrast(shade, p.background), contrast(shade, p.raised),
                     contrast(shade, p.band)}) >= least;
  };
  float share = 0.0F;
  while (!enough(glm::mix(colour, end, share)) && share < 1.0F) share += kStep;
  known.push_back({colour, end, least, theme, glm::mix(colour, end, share)});
  return known.back().result;
}

Rgb legible(const Rgb& colour, Theme theme) noexcept {
  return mixed_until(colour, Rgb(theme == Theme::light ? 0.0F : 1.0F), kLeastContrast, theme);
}

Rgb shade_of(std::uint32_t hue, Theme theme) noexcept {
  const auto known = std::ranges::find(kShadesOfHues, hue, &Shades::hue);
  if (known == kShadesOfHues.end()) return legible(hex(hue), theme);
  return hex(theme == Theme::light ? known->light : known->dark);
}

}  // namespace

const Palette& palette(Theme theme) noexcept { return theme == Theme::light ? kLight : kDark; }

double contrast(const Rgb& a, const Rgb& b) noexcept {
  const double high = std::max(luminance(a), luminance(b));
  const double low = std::min(luminance(a), luminance(b));
  return (high + 0.05) / (low + 0.05);
}

Rgb method_colour(std::string_view method, Theme theme, std::size_t which) {
  // Shares of white; negative: of black.
  constexpr std::array<float, 4> kShades{-0.42F, 0.45F, -0.66F, 0.25F};
  const std::uint32_t hue = method_rgb(method);
  const Rgb colour = hue != 0 ? shade_of(hue, theme) : Rgb(theme == Theme::light ? 0.0F : 1.0F);
  if (which == 0) return colour;
  // The first shade moves away from the background.
  const bool turned = colour == Rgb(0.0F) || (theme == Theme::dark && colour != Rgb(1.0F));
  const float shade = kShades[(which - 1) % kShades.size()] * (turned ? -1.0F : 1.0F);
  return legible(glm::mix(colour, Rgb(shade < 0.0F ? 0.0F : 1.0F), std::abs(shade)), theme);
}

Rgb reference_colour(Theme theme) noexcept { return shade_of(kReference, theme); }

Rgb text_colour(const Rgb& colour, Theme theme) noexcept {
  return mixed_until(colour, Rgb(theme == Theme::light ? 0.0F : 1.0F), kLeastTextContrast, theme);
}

Rgb outline_on(const Rgb& block) noexcept {
  return contrast(kDarkOutline, block) >= contrast(kLightOutline, block) ? kDarkOutline : kLightOutline;
}

Rgb error_colour(double error_over_jnd) noexcept {
  if (!(error_over_jnd <= 1.0)) return kAboveJndColour;
  const double place = std::max(0.0, error_over_jnd) * static_cast<double>(kScale.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), kScale.size() - 2);
  return glm::mix(kScale[below], kScale[below + 1], static_cast<float>(place - static_cast<double>(below)));
}

}  // namespace palpate
