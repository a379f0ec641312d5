#include "rendering/ui/colours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "models/correction/methods.h"
#include "scenes/scene/scene.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

const std::vector<const char*> kMethods = [] {
  std::vector<const char*> names;
  for (const Method* method : methods()) names.push_back(method->name);
  return names;
}();

// What texts, curves and marks are drawn on.
std::array<Rgb, 4> surfaces(Theme theme) {
  const Palette& p = palette(theme);
  return {p.panel, p.background, p.raised, p.band};
}

TEST(Colours, TextCanBeReadInBothThemes) {
  for (const Theme theme : {Theme::light, Theme::dark}) {
    const Palette& p = palette(theme);
    for (const Rgb& behind : surfaces(theme)) {
      EXPECT_GE(contrast(p.text, behind), 7.0);
      EXPECT_GE(contrast(p.quiet, behind), kLeastTextContrast);
      EXPECT_GE(contrast(p.fault, behind), kLeastContrast) << "lines and marks";
      EXPECT_GE(contrast(text_colour(kAboveJndColour, theme), behind), kLeastTextContrast);
      EXPECT_GE(contrast(text_colour(reference_colour(theme), theme), behind), kLeastTextContrast);
      for (const char* method : kMethods)
        EXPECT_GE(contrast(text_colour(method_colour(method, theme), theme), behind), kLeastTextContrast) << method;
    }
    EXPECT_GE(contrast(p.fault, p.panel), kLeastTextContrast);
  }
}

// WCAG 2.1, 1.4.11: a contrast of 3 : 1 for all elements with a meaning.
TEST(Colours, WhatCarriesAMeaningIsSeenInBothThemes) {
  for (const Theme theme : {Theme::light, Theme::dark}) {
    const Palette& p = palette(theme);
    for (const Rgb& behind : surfaces(theme)) {
      for (const char* method : kMethods) {
        for (std::size_t which = 0; which < 5; ++which)
          EXPECT_GE(contrast(method_colour(method, theme, which), behind), kLeastContrast) << method << which;
      }
      EXPECT_GE(contrast(reference_colour(theme), behind), kLeastContrast);
      EXPECT_GE(contrast(kAboveJndColour, behind), kLeastContrast);
      EXPECT_GE(contrast(p.edge, behind), kLeastContrast) << "controls, the band and the scale of errors";
      EXPECT_GE(contrast(p.rubber, behind), kLeastContrast) << "the probe";
    }
    EXPECT_GE(contrast(p.edge, p.table), kLeastContrast) << "the outline of a block";
  }
}

// Arrow, probe, frame and the coloured dent have an outline where they are in front of a block.
TEST(Colours, AnOutlineIsSeenOnEveryBlockAndBesideEveryError) {
  const Result names = test::must(scene_names());
  for (const std::string& name : *names) {
    const Result scene = test::must(load_scene(name));
    const Rgb block = hex(scene->block_colour);
    EXPECT_GE(contrast(outline_on(block), block), kLeastContrast) << name;
    for (double error = 0.0; error <= 2.0; error += 0.1) {
      const Rgb dent = error_colour(error);
      EXPECT_GE(std::max(contrast(dent, outline_on(block)), contrast(dent, block)), kLeastContrast) << name << error;
    }
  }
}

// CIELAB of a colour as it is seen; `seen`: a matrix on linear RGB.
using Matrix = std::array<std::array<double, 3>, 3>;
std::array<double, 3> lab(const Rgb& colour, const Matrix& seen) {
  std::array<double, 3> linear{}, mixed{}, f{};
  for (int i = 0; i < 3; ++i) {
    const double value = static_cast<double>(colour[i]);
    linear[static_cast<std::size_t>(i)] = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  }
  const auto times = [](const Matrix& m, const std::array<double, 3>& v) {
    std::array<double, 3> out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
    return out;
  };
  mixed = times(seen, linear);
  for (double& value : mixed) value = std::clamp(value, 0.0, 1.0);
  constexpr Matrix kXyz{
      {{0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}}};
  constexpr std::array<double, 3> kWhite{0.95047, 1.0, 1.08883};
  const std::array<double, 3> xyz = times(kXyz, mixed);
  for (std::size_t i = 0; i < 3; ++i) {
    const double share = xyz[i] / kWhite[i];
    f[i] = share > 216.0 / 24389.0 ? std::cbrt(share) : share * 841.0 / 108.0 + 4.0 / 29.0;
  }
  return {116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])};
}

// Machado, Oliveira & Fernandes (2009), severity 1.
TEST(Colours, WhatMustBeToldApartDiffersForEveryEye) {
  constexpr Matrix kEyes[] = {
      {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}},
      {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}},
      {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}}};
  constexpr double kLeast = 20.0;
  for (const Matrix& eye : kEyes) {
    const auto differ = [&](const Rgb& a, const Rgb& b) {
      const auto one = lab(a, eye), other = lab(b, eye);
      return std::hypot(one[0] - other[0], one[1] - other[1], one[2] - other[2]);
    };
    for (const Theme theme : {Theme::light, Theme::dark}) {
      std::vector<std::pair<std::string, Rgb>> lines{{"truth", reference_colour(theme)}};
      for (const char* method : {"trend+greedy", "voxel", "random", "kdtree", "greedy"})
        lines.emplace_back(method, method_colour(method, theme));
      for (std::size_t i = 0; i < lines.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
          EXPECT_GE(differ(lines[i].second, lines[k].second), kLeast) << lines[i].first << ", " << lines[k].first;
      for (const double error : {0.0, 0.25, 0.5, 0.75, 1.0})
        EXPECT_GE(differ(error_colour(error), reference_colour(theme)), kLeast)
            << "the truth is green, no error " << error;
    }
    EXPECT_GE(differ(error_colour(0.0), error_colour(0.5)), kLeast);
    EXPECT_GE(differ(error_colour(0.5), error_colour(1.0)), kLeast);
    EXPECT_GE(differ(error_colour(1.0), kAboveJndColour), kLeast) << "just noticeable, and above";
  }
}

}  // namespace
}  // namespace palpate
