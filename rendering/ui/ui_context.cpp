#include "rendering/ui/ui_context.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <algorithm>
#include <cfloat>
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

// Appends the commands of a list that draw in a part of the window, clipped to it, with their triangles there.
void add_commands_in(const ImDrawList& list, const ImVec4& part, ImVector<ImDrawCmd>& commands,
                     ImVector<ImDrawIdx>& indices) {
  for (ImDrawCmd command : list.CmdBuffer) {
    ImVec4& clip = command.ClipRect;
    // The whole pixels that ImGui's backend makes of it, so that no line is missing between two parts.
    const float left = std::floor(clip.x), right = left + std::floor(clip.z - clip.x);
    const float bottom = std::ceil(clip.w), top = bottom - std::floor(clip.w - clip.y);
    clip = {std::max(left, part.x), std::max(top, part.y), std::min(right, part.z), std::min(bottom, part.w)};
    if (clip.x >= clip.z || clip.y >= clip.w) continue;
    const ImDrawIdx* const first = list.IdxBuffer.Data + command.IdxOffset;
    command.IdxOffset = static_cast<unsigned>(indices.Size);
    for (const ImDrawIdx* corner = first; corner < first + command.ElemCount; corner += 3) {
      const auto at = [&](int k) { return list.VtxBuffer[static_cast<int>(corner[k] + command.VtxOffset)].pos; };
      const ImVec2 a = at(0), b = at(1), c = at(2);
      const bool beside = std::min(a.x, std::min(b.x, c.x)) > clip.z || std::max(a.x, std::max(b.x, c.x)) < clip.x;
      if (beside || std::min(a.y, std::min(b.y, c.y)) > clip.w || std::max(a.y, std::max(b.y, c.y)) < clip.y) continue;
      for (int k = 0; k < 3; ++k) indices.push_back(corner[k]);
    }
    command.ElemCount = static_cast<unsigned>(indices.Size) - command.IdxOffset;
    if (command.ElemCount > 0) commands.push_back(command);
  }
}

}  // namespace

UiContext::UiContext(GLFWwindow* window) : window_(window) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // ImGui stores no window positions
  ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  ImGui_ImplGlfw_InitForOpenGL(window, true);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

UiContext::~UiContext() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void UiContext::begin_frame(const std::vector<int>& tapped) {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  // When the mouse leaves the window, no element is under it.
  const bool held = ImGui::IsMouseDown(ImGuiMouseButton_Left) || ImGui::IsMouseDown(ImGuiMouseButton_Right);
  if (!held && glfwGetWindowAttrib(window_, GLFW_HOVERED) == 0) ImGui::GetIO().MousePos = {-FLT_MAX, -FLT_MAX};
  // ImGui samples its keys once a frame and would miss these.
  const auto report = [&](bool down) {
    for (const int key : tapped) ImGui::GetIO().KeysDown[key] = down;
  };
  report(true);
  ImGui::NewFrame();
  report(false);
}

void UiContext::end_frame() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void UiContext::draw_again(const std::vector<Viewport>& parts) const {
  ImDrawData& data = *ImGui::GetDrawData();
  const ImVec2 scale = data.FramebufferScale;
  std::vector<ImVec4> within;  // the parts in the window's units, with the origin at the upper left
  for (const Viewport& part : parts) {
    const auto low = ImVec2(static_cast<float>(part.x) / scale.x, static_cast<float>(part.y) / scale.y);
    const auto high =
        ImVec2(low.x + static_cast<float>(part.width) / scale.x, low.y + static_cast<float>(part.height) / scale.y);
    within.push_back({std::floor(low.x), std::floor(data.DisplaySize.y - high.y), std::ceil(high.x),
                      std::ceil(data.DisplaySize.y - low.y)});
  }
  // The commands and triangles that are in a part take the place of all, for this call only.
  std::vector<ImDrawList*> lists;
  std::vector<std::pair<ImVector<ImDrawCmd>, ImVector<ImDrawIdx>>> kept;
  for (int n = 0; n < data.CmdListsCount; ++n) {
    ImDrawList& list = *data.CmdLists[n];
    ImVector<ImDrawCmd> commands;
    ImVector<ImDrawIdx> indices;
    for (const ImVec4& part : within) add_commands_in(list, part, commands, indices);
    if (commands.empty()) continue;
    lists.push_back(&list);
    kept.emplace_back();
    list.CmdBuffer.swap(commands);
    list.IdxBuffer.swap(indices);
    kept.back().first.swap(commands);
    kept.back().second.swap(indices);
  }
  if (lists.empty()) return;
  ImDrawData some = data;
  some.CmdLists = lists.data();
  some.CmdListsCount = static_cast<int>(lists.size());
  ImGui_ImplOpenGL3_RenderDrawData(&some);
  for (std::size_t i = 0; i < lists.size(); ++i) {
    lists[i]->CmdBuffer.swap(kept[i].first);
    lists[i]->IdxBuffer.swap(kept[i].second);
  }
}

std::vector<Viewport> UiContext::changed_parts(const std::vector<Viewport>& also) {
  const ImDrawData& widgets = *ImGui::GetDrawData();
  const ImVec2 scale = widgets.FramebufferScale;
  const int width = static_cast<int>(std::lround(widgets.DisplaySize.x * scale.x));
  const int height = static_cast<int>(std::lround(widgets.DisplaySize.y * scale.y));
  const bool resized = width != width_ || height != height_;
  width_ = width;
  height_ = height;
  columns_ = (width + kTile - 1) / kTile;
  rows_ = (height + kTile - 1) / kTile;
  std::vector<std::uint64_t> tiles = hashes(widgets);
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

// A hash of the triangles in each tile.
std::vector<std::uint64_t> UiContext::hashes(const ImDrawData& widgets) const {
  std::vector<std::uint64_t> tiles(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
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
  return tiles;
}

// Each grows to the right, then down.
std::vector<Viewport> UiContext::rectangles(std::vector<bool> changed) const {
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
