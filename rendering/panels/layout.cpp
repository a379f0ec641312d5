#include "rendering/panels/layout.h"

#include <cmath>

namespace palpate {
namespace {

constexpr float kSceneShare = 0.6F;    // of the width
constexpr float kSceneHeight = 0.45F;  // of the height, above the panel
constexpr float kTall = 1.1F;          // ratio of width to height below which the panel is below the scene

}  // namespace

WindowLayout lay_out(const ImVec2& window) {
  WindowLayout layout;
  if (window.x < kTall * window.y) {
    const float height = std::round(kSceneHeight * window.y);
    layout.scene = {{0.0F, 0.0F}, {window.x, height}};
    layout.panel = {{0.0F, height}, {window.x, window.y - height}};
  } else {
    const float width = std::round(kSceneShare * window.x);
    layout.scene = {{0.0F, 0.0F}, {width, window.y}};
    layout.panel = {{width, 0.0F}, {window.x - width, window.y}};
  }
  return layout;
}

}  // namespace palpate
