// Where the parts of the window are. A pure function of its size.
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

// The panel beside the scene; below it in a window that is hardly wider than high.
WindowLayout lay_out(const ImVec2& window);

}  // namespace palpate
