// Finds the parts of the window in which the widgets of a frame differ from those of the frame before: a hash of the
// triangles in each tile. Most texts stay the same for seconds, and a software renderer needs as long for them as for
// the picture.
// Thread guarantee: value type.
#pragma once

#include <imgui.h>

#include <cstdint>
#include <vector>

#include "rendering/ui/viewport.h"

namespace palpate {

class WidgetChanges {
 public:
  // Returns the parts that differ from the last call and those `also` to be drawn, as rectangles without overlap, in
  // pixels with the origin at the lower left corner. After a change of the window's size that is everything.
  std::vector<Viewport> update(const ImDrawData& widgets, const std::vector<Viewport>& also);

 private:
  void add(const ImDrawData& widgets, std::vector<std::uint64_t>& tiles) const;
  std::vector<Viewport> rectangles(std::vector<bool> changed) const;

  int width_ = 0, height_ = 0;  // of the window, pixels
  int columns_ = 0, rows_ = 0;
  std::vector<std::uint64_t> tiles_;  // by rows, the upper one first
};

}  // namespace palpate
