// A rectangle in pixels of a picture or of the window.
// Thread guarantee: values.
#pragma once

namespace palpate {

struct Viewport {
  int x = 0, y = 0, width = 0, height = 0;
  bool empty() const noexcept { return width <= 0 || height <= 0; }
  bool operator==(const Viewport&) const = default;
};
// The smallest rectangle around both, and their common part; an empty one has no part in it.
Viewport around_both(const Viewport& a, const Viewport& b) noexcept;
Viewport common_part(const Viewport& a, const Viewport& b) noexcept;

}  // namespace palpate
