#include "rendering/ui/widget_changes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace palpate {
namespace {

constexpr int kTile = 32;  // pixels per side: the height of two lines of text

// Odd, with irregular bits: 2^64 divided by the golden ratio.
std::uint64_t mixed(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9E3779B97F4A7C15U;
  return hash ^ (hash >> 32);
}

template <typename T>
std::uint64_t mixed_bytes(std::uint64_t hash, const T& value) {
  std::uint64_t words[(sizeof(T) + 7) / 8] = {};
  std::memcpy(words, &value, sizeof(T));
  for (const std::uint64_t word : words) hash = mixed(hash, word);
  return hash;
}

// The tiles from one coordinate to another, both inclusive.
std::pair<int, int> tiles_between(float from, float to, int count) {
  const auto tile = [](float at) { return static_cast<int>(std::floor(at / kTile)); };
  return {std::max(0, tile(from)), std::min(count - 1, tile(to))};
}

}  // namespace

std::vector<Viewport> WidgetChanges::update(const ImDrawData& widgets, const std::vector<Viewport>& also) {
  const ImVec2 scale = widgets.FramebufferScale;
  const int width = static_cast<int>(std::lround(widgets.DisplaySize.x * scale.x));
  const int height = static_cast<int>(std::lround(widgets.DisplaySize.y * scale.y));
  const bool resized = width != width_ || height != height_;
  width_ = width;
  height_ = height;
  columns_ = (width + kTile - 1) / kTile;
  rows_ = (height + kTile - 1) / kTile;
  std::vector<std::uint64_t> tiles(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  add(widgets, tiles);
  std::vector<bool> changed(tiles.size(), resized);
  for (std::size_t i = 0; !resized && i < tiles.size(); ++i) changed[i] = tiles[i] != tiles_[i];
  for (const Viewport& asked : also) {
    const Viewport part = common_part(asked, {0, 0, width, height});
    for (int top = height - part.y - part.height, y = top / kTile; !part.empty() && y * kTile < top + part.height; ++y)
      for (int x = part.x / kTile; x * kTile < part.x + part.width; ++x)
        changed[static_cast<std::size_t>(y * columns_ + x)] = true;
  }
  tiles_ = std::move(tiles);
  return rectangles(std::move(changed));
}

void WidgetChanges::add(const ImDrawData& widgets, std::vector<std::uint64_t>& tiles) const {
  const ImVec2 scale = widgets.FramebufferScale;
  for (int n = 0; n < widgets.CmdListsCount; ++n) {
    const ImDrawList& list = *widgets.CmdLists[n];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      const ImVec4& clip = command.ClipRect;
      const std::uint64_t start = mixed_bytes(reinterpret_cast<std::uintptr_t>(command.TextureId), clip);
      const ImDrawIdx* const first = list.IdxBuffer.Data + command.IdxOffset;
      for (const ImDrawIdx* corner = first; corner < first + command.ElemCount; corner += 3) {
        ImVec2 low(clip.z, clip.w), high(clip.x, clip.y);
        std::uint64_t hash = start;
        for (int k = 0; k < 3; ++k) {
          const ImDrawVert& vertex = list.VtxBuffer[static_cast<int>(corner[k] + command.VtxOffset)];
          hash = mixed_bytes(hash, vertex);
          low = {std::min(low.x, vertex.pos.x), std::min(low.y, vertex.pos.y)};
          high = {std::max(high.x, vertex.pos.x), std::max(high.y, vertex.pos.y)};
        }
        const auto [left, right] =
            tiles_between(std::max(low.x, clip.x) * scale.x, std::min(high.x, clip.z) * scale.x, columns_);
        const auto [top, bottom] =
            tiles_between(std::max(low.y, clip.y) * scale.y, std::min(high.y, clip.w) * scale.y, rows_);
        for (int y = top; y <= bottom; ++y) {
          for (int x = left; x <= right; ++x) {
            std::uint64_t& tile = tiles[static_cast<std::size_t>(y * columns_ + x)];
            tile = mixed(tile, hash);
          }
        }
      }
    }
  }
}

// Each grows to the right, then down.
std::vector<Viewport> WidgetChanges::rectangles(std::vector<bool> changed) const {
  std::vector<Viewport> parts;
  const auto at = [&](int x, int y) { return changed[static_cast<std::size_t>(y * columns_ + x)]; };
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) {
      if (!at(x, y)) continue;
      int right = x, below = y;
      while (right < columns_ && at(right, y)) ++right;
      const auto whole_row = [&](int row) {
        for (int i = x; i < right; ++i)
          if (!at(i, row)) return false;
        return true;
      };
      while (below < rows_ && whole_row(below)) {
        for (int i = x; i < right; ++i) changed[static_cast<std::size_t>(below * columns_ + i)] = false;
        ++below;
      }
      const Viewport grown{x * kTile, height_ - below * kTile, (right - x) * kTile, (below - y) * kTile};
      parts.push_back(common_part(grown, {0, 0, width_, height_}));
    }
  }
  return parts;
}

}  // namespace palpate
