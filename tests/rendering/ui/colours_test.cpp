#include "rendering/ui/colours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace palpate {
namespace {

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

TEST(Colours, ContrastIsThatOfWcag) {
  EXPECT_NEAR(contrast(Rgb(0.0F), Rgb(1.0F)), 21.0, 1e-4);
  EXPECT_NEAR(contrast(Rgb(1.0F, 0.0F, 0.0F), Rgb(1.0F)), 3.998, 1e-3) << "published examples";
  EXPECT_NEAR(contrast(Rgb(1.0F), Rgb(0.466667F)), 4.478, 1e-3) << "#777777";
  EXPECT_EQ(contrast(Rgb(0.3F), Rgb(0.3F)), 1.0);
}

// WCAG 2.1, 1.4.11: a contrast of 3 : 1 for all elements with a meaning.
TEST(Colours, WhatCarriesAMeaningIsSeenInBothThemes) {
  for (const Theme theme : {Theme::light, Theme::dark}) {
    const Palette& p = palette(theme);
    for (const Rgb& behind : {p.panel, p.background}) {
      for (const char* method : {"trend", "direct", "voxel", "random", "kdtree", "greedy", "position"}) {
        for (std::size_t which = 0; which < 5; ++which)
          EXPECT_GE(contrast(method_colour(method, theme, which), behind), kLeastContrast) << method << which;
      }
      EXPECT_GE(contrast(kReferenceColour, behind), kLeastContrast);
      EXPECT_GE(contrast(kAboveJndColour, behind), kLeastContrast);
      EXPECT_GE(contrast(p.rubber, behind), kLeastContrast) << "the probe";
    }
  }
}

TEST(Colours, AHueThatIsSeenStaysAsItIs) {
  EXPECT_EQ(method_colour("greedy", Theme::light), (Rgb(213.0F, 94.0F, 0.0F) / 255.0F));
  EXPECT_EQ(method_colour("voxel", Theme::dark), (Rgb(86.0F, 180.0F, 233.0F) / 255.0F));
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
  const Rgb black(0.0F);
  double last = 21.0;
  EXPECT_GT(contrast(error_colour(0.0), black), 17.0) << "no error is no shadow";
  for (double error = 0.0; error <= 1.0; error += 0.05) {
    const double now = contrast(error_colour(error), black);
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
