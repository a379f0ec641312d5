#include "rendering/ui/viewport.h"

#include <algorithm>

namespace palpate {

Viewport around_both(const Viewport& a, const Viewport& b) noexcept {
  if (a.empty()) return b;
  if (b.empty()) return a;
  const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
  return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

Viewport common_part(const Viewport& a, const Viewport& b) noexcept {
  const int x = std::max(a.x, b.x), y = std::max(a.y, b.y);
  const int right = std::min(a.x + a.width, b.x + b.width), high = std::min(a.y + a.height, b.y + b.height);
  return {x, y, std::max(0, right - x), std::max(0, high - y)};
}

}  // namespace palpate
