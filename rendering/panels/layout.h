// Layout of the window, a pure function of its size.
#pragma once

#include <imgui.h>

namespace palpate {

// A part of the window, in ImGui's coordinates.
struct SceneArea {
  ImVec2 at;
  ImVec2 size;
  bool holds(const ImVec2& point) const {
    return point.x >= at.x && point.y >= at.y && point.x < at.x + size.x && point.y < at.y + size.y;
  }
};

struct WindowLayout {
  SceneArea scene;
  SceneArea panel;
};

// The panel is beside the scene; below it where the width is less than 1.1 times the height.
WindowLayout lay_out(const ImVec2& window);

}  // namespace palpate
