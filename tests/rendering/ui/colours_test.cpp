#include "rendering/ui/colours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace palpate {
namespace {

// Relative luminance and contrast ratio of WCAG 2.
double luminance(const Rgb& colour) {
  const auto linear = [](float c) {
    const auto value = static_cast<double>(c);
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(colour.r) + 0.7152 * linear(colour.g) + 0.0722 * linear(colour.b);
}

double contrast(const Rgb& a, const Rgb& b) {
  const double high = std::max(luminance(a), luminance(b));
  const double low = std::min(luminance(a), luminance(b));
  return (high + 0.05) / (low + 0.05);
}

TEST(Colours, TextCanBeReadInBothThemes) {
  for (const Theme theme : {Theme::light, Theme::dark}) {
    const Palette& p = palette(theme);
    EXPECT_GE(contrast(p.text, p.panel), 7.0);
    EXPECT_GE(contrast(p.text, p.raised), 7.0);
    EXPECT_GE(contrast(p.quiet, p.panel), 4.5);
    EXPECT_GE(contrast(p.quiet, p.background), 4.5);
    EXPECT_GE(contrast(p.fault, p.panel), 4.5);
  }
}

TEST(Colours, MethodsDifferFromEachOtherAndFromTheReference) {
  const char* methods[] = {"trend", "direct", "voxel", "random", "kdtree", "greedy", "position"};
  for (const Theme theme : {Theme::light, Theme::dark}) {
    for (const char* a : methods) {
      EXPECT_GT(glm::distance(method_colour(a, theme), kReferenceColour), 0.3F) << a;
      for (const char* b : methods) {
        if (a == b) continue;
        EXPECT_GT(glm::distance(method_colour(a, theme), method_colour(b, theme)), 0.25F) << a << ", " << b;
      }
    }
  }
}

TEST(Colours, TheScaleDarkensFromLightAndEndsAtOne) {
  double last = 1.0;
  EXPECT_GT(luminance(error_colour(0.0)), 0.8) << "no error is no shadow";
  for (double error = 0.0; error <= 1.0; error += 0.05) {
    const double now = luminance(error_colour(error));
    EXPECT_LT(now, last) << error;
    last = now;
  }
  EXPECT_EQ(error_colour(1.001), kAboveJndColour);
  EXPECT_EQ(error_colour(50.0), kAboveJndColour);
  EXPECT_EQ(error_colour(std::nan("")), kAboveJndColour) << "unknown is never shown as good";
  EXPECT_EQ(error_colour(-1.0), error_colour(0.0));
}

}  // namespace
}  // namespace palpate
