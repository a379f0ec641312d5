// A rectangle in pixels of a picture or of the window.
// Thread guarantee: values.
#pragma once

#include <algorithm>

namespace palpate {

struct Viewport {
  int x = 0, y = 0, width = 0, height = 0;
  bool empty() const noexcept { return width <= 0 || height <= 0; }
  bool operator==(const Viewport&) const = default;
};

// The smallest rectangle around both; an empty one has no part in it.
inline Viewport around_both(const Viewport& a, const Viewport& b) noexcept {
  if (a.empty()) return b;
  if (b.empty()) return a;
  const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
  return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

inline Viewport common_part(const Viewport& a, const Viewport& b) noexcept {
  const int x = std::max(a.x, b.x), y = std::max(a.y, b.y);
  const int right = std::min(a.x + a.width, b.x + b.width), high = std::min(a.y + a.height, b.y + b.height);
  return {x, y, std::max(0, right - x), std::max(0, high - y)};
}

}  // namespace palpate
