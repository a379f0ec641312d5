#include "rendering/ui/colours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <string>

#include "models/correction/methods.h"
#include "scenes/scene/scene.h"

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
  const auto names = scene_names();
  ASSERT_TRUE(names.ok());
  for (const std::string& name : *names) {
    const auto scene = load_scene(name);
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    const Rgb block = hex(scene->block_colour);
    EXPECT_GE(contrast(outline_on(block), block), kLeastContrast) << name;
    for (double error = 0.0; error <= 2.0; error += 0.1) {
      const Rgb dent = error_colour(error);
      EXPECT_GE(std::max(contrast(dent, outline_on(block)), contrast(dent, block)), kLeastContrast) << name << error;
    }
  }
}

TEST(Colours, MethodsDifferFromEachOtherAndFromTheReference) {
  for (const Theme theme : {Theme::light, Theme::dark}) {
    for (const char* a : kMethods) {
      EXPECT_GT(glm::distance(method_colour(a, theme), reference_colour(theme)), 0.3F) << a;
      for (const char* b : kMethods) {
        if (a == b) continue;
        EXPECT_GT(glm::distance(method_colour(a, theme), method_colour(b, theme)), 0.25F) << a << ", " << b;
      }
    }
  }
}

}  // namespace
}  // namespace palpate
