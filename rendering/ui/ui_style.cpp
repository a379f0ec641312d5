#include "rendering/ui/ui_style.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <filesystem>
#include <glm/common.hpp>
#include <initializer_list>

namespace palpate {
namespace {

// Font sizes for a window of 1080 lines.
constexpr float kHeading_px = 28.0F;
constexpr float kBig_px = 54.0F;
constexpr float kDesignHeight = 1080.0F;
// In a tall window the scale follows the width.
constexpr float kDesignWidth = 1500.0F;
// Text of a smaller scale is not legible.
constexpr float kSmallestScale = 0.78F;
constexpr float kLargestScale = 4.0F;
// The scale changes in steps, so that resizing a window does not rebuild the fonts in every frame.
constexpr float kScaleStep = 0.04F;

// DejaVu Sans and other fonts with tabular figures, at the paths of common distributions.
constexpr const char* kFontFiles[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf", "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf"};

// Side of the squares in which the window is searched for widgets, in its units.
constexpr int kTile = 16;

// Latin letters and the signs that the panel uses.
constexpr ImWchar kGlyphs[] = {0x20,   0xFF,   0x2013, 0x2026, 0x2190, 0x2193, 0x2264,
                               0x2265, 0x25A0, 0x25CF, 0x3BC,  0x3C4,  0};

ImFont* add_font(const std::string& path, float size_px) {
  ImGuiIO& io = ImGui::GetIO();
  if (!path.empty()) return io.Fonts->AddFontFromFileTTF(path.c_str(), size_px, nullptr, kGlyphs);
  ImFontConfig plain;
  plain.SizePixels = size_px;
  return io.Fonts->AddFontDefault(&plain);
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
  note_tiles();
}

// Notes where the triangles of the frame are.
void UiContext::note_tiles() {
  const ImDrawData& data = *ImGui::GetDrawData();
  columns_ = static_cast<int>(data.DisplaySize.x) / kTile + 1;
  rows_ = static_cast<int>(data.DisplaySize.y) / kTile + 1;
  tiles_.assign(static_cast<std::size_t>(columns_ * rows_), false);
  const auto tile = [](float at, int count) { return std::clamp(static_cast<int>(at) / kTile, 0, count - 1); };
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      const ImVec4& clip = command.ClipRect;
      for (unsigned i = 0; i + 2 < command.ElemCount; i += 3) {
        ImVec2 low(FLT_MAX, FLT_MAX), high(-FLT_MAX, -FLT_MAX);
        for (unsigned k = 0; k < 3; ++k) {
          const unsigned vertex = list.IdxBuffer[static_cast<int>(command.IdxOffset + i + k)] + command.VtxOffset;
          const ImVec2& at = list.VtxBuffer[static_cast<int>(vertex)].pos;
          low = {std::min(low.x, at.x), std::min(low.y, at.y)};
          high = {std::max(high.x, at.x), std::max(high.y, at.y)};
        }
        if (low.x > clip.z || low.y > clip.w || high.x < clip.x || high.y < clip.y) continue;
        const int right = tile(std::min(high.x, clip.z), columns_), bottom = tile(std::min(high.y, clip.w), rows_);
        for (int y = tile(std::max(low.y, clip.y), rows_); y <= bottom; ++y)
          for (int x = tile(std::max(low.x, clip.x), columns_); x <= right; ++x)
            tiles_[static_cast<std::size_t>(y * columns_ + x)] = true;
      }
    }
  }
}

// The smallest rectangle around the widgets in a part, both in the window's units with the origin at the upper left.
Viewport UiContext::drawn_part(const Viewport& part) const {
  Viewport drawn;
  for (int y = std::max(0, part.y / kTile); y < std::min(rows_, (part.y + part.height - 1) / kTile + 1); ++y) {
    for (int x = std::max(0, part.x / kTile); x < std::min(columns_, (part.x + part.width - 1) / kTile + 1); ++x)
      if (tiles_[static_cast<std::size_t>(y * columns_ + x)])
        drawn = around_both(drawn, common_part(part, {x * kTile, y * kTile, kTile, kTile}));
  }
  return drawn;
}

void UiContext::draw_again(const std::vector<Viewport>& parts) const {
  ImDrawData& data = *ImGui::GetDrawData();
  const ImVec2 scale = data.FramebufferScale;
  for (const Viewport& part : parts) {
    const auto at = [](int pixels, float by, bool up) {
      const float units = static_cast<float>(pixels) / by;
      return static_cast<int>(up ? std::ceil(units) : std::floor(units));
    };
    const int left = at(part.x, scale.x, false), right = at(part.x + part.width, scale.x, true);
    const int high = static_cast<int>(data.DisplaySize.y);
    const int top = high - at(part.y + part.height, scale.y, true), bottom = high - at(part.y, scale.y, false);
    const Viewport drawn = drawn_part({left, top, right - left, bottom - top});
    if (drawn.empty()) continue;
    // The commands clipped to the part, for this call only.
    std::vector<ImVec4> clips;
    const ImVec4 within(static_cast<float>(drawn.x), static_cast<float>(drawn.y),
                        static_cast<float>(drawn.x + drawn.width), static_cast<float>(drawn.y + drawn.height));
    for (int n = 0; n < data.CmdListsCount; ++n) {
      for (ImDrawCmd& command : data.CmdLists[n]->CmdBuffer) {
        ImVec4& clip = command.ClipRect;
        clips.push_back(clip);
        clip = {std::max(clip.x, within.x), std::max(clip.y, within.y), std::min(clip.z, within.z),
                std::min(clip.w, within.w)};
      }
    }
    ImGui_ImplOpenGL3_RenderDrawData(&data);
    auto clip = clips.begin();
    for (int n = 0; n < data.CmdListsCount; ++n)
      for (ImDrawCmd& command : data.CmdLists[n]->CmdBuffer) command.ClipRect = *clip++;
  }
}

std::string find_font() {
  for (const char* path : kFontFiles) {
    std::error_code missing;
    if (std::filesystem::exists(path, missing)) return path;
  }
  return {};
}

float ui_scale(const UiSize& size, float larger) noexcept {
  const float unit = size.content_scale / size.pixels_per_unit;
  const float fit = std::min(size.height / kDesignHeight, size.width / kDesignWidth) / unit;
  const float scale = std::clamp(fit, kSmallestScale, kLargestScale) * larger;
  return unit * kScaleStep * std::round(scale / kScaleStep);
}

void UiStyle::update(const UiSize& size, float larger, Theme theme, float body_px) {
  const float wanted = ui_scale(size, larger);
  const bool resized = wanted != scale_ || size.pixels_per_unit != pixels_per_unit_ || body_px != body_px_;
  if (!resized && theme == theme_) return;
  scale_ = wanted;
  pixels_per_unit_ = size.pixels_per_unit;
  body_px_ = body_px;
  theme_ = theme;
  if (resized) build_fonts();
  set_colours();
}

// Builds fonts in pixels of the framebuffer, so that they are sharp; they are drawn in units of the window.
void UiStyle::build_fonts() {
  ImGuiIO& io = ImGui::GetIO();
  const std::string path = find_font();
  io.Fonts->Clear();
  const auto add = [&](float size_px) {
    ImFont* font = add_font(path, std::round(size_px * scale_ * pixels_per_unit_));
    font->Scale = 1.0F / pixels_per_unit_;
    return font;
  };
  fonts_.body = add(body_px_);
  fonts_.heading = add(kHeading_px);
  fonts_.big = add(kBig_px);
  io.FontDefault = fonts_.body;
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

void UiStyle::set_colours() {
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  style.WindowRounding = style.ChildRounding = 0.0F;
  style.FrameRounding = style.PopupRounding = style.GrabRounding = 4.0F;
  style.WindowBorderSize = 0.0F;
  style.FrameBorderSize = 1.0F;  // buttons and sliders are visible on a picture of any brightness
  style.WindowPadding = {12.0F, 8.0F};
  style.ItemSpacing = {8.0F, 5.0F};
  style.FramePadding = {8.0F, 3.0F};
  style.CellPadding = {5.0F, 1.0F};
  style.ScaleAllSizes(std::max(scale_, 0.5F));
  const Palette& p = colours();
  const auto set = [&](const Rgb& colour, float alpha, std::initializer_list<ImGuiCol> parts) {
    for (const ImGuiCol part : parts) style.Colors[part] = paint(colour, alpha);
  };
  set(p.text, 1.0F, {ImGuiCol_Text, ImGuiCol_SliderGrabActive, ImGuiCol_CheckMark});
  set(p.text, 0.03F, {ImGuiCol_TableRowBgAlt});
  set(p.quiet, 1.0F, {ImGuiCol_TextDisabled, ImGuiCol_SliderGrab, ImGuiCol_NavHighlight});
  set(p.quiet, 1.0F, {ImGuiCol_PlotHistogram});  // progress bars
  set(p.panel, 1.0F, {ImGuiCol_WindowBg});
  set(p.panel, 0.98F, {ImGuiCol_PopupBg});
  set(p.panel, 0.0F, {ImGuiCol_ChildBg, ImGuiCol_ScrollbarBg});
  set(p.edge, 1.0F, {ImGuiCol_Border, ImGuiCol_ScrollbarGrab});
  set(p.grid, 1.0F, {ImGuiCol_TableBorderLight, ImGuiCol_TableBorderStrong, ImGuiCol_Separator});
  set(p.raised, 1.0F,
      {ImGuiCol_TitleBg, ImGuiCol_TitleBgActive, ImGuiCol_TitleBgCollapsed, ImGuiCol_FrameBg, ImGuiCol_Button,
       ImGuiCol_Header, ImGuiCol_TableHeaderBg, ImGuiCol_Tab});
  set(glm::mix(p.raised, p.text, 0.12F), 1.0F,
      {ImGuiCol_FrameBgHovered, ImGuiCol_ButtonHovered, ImGuiCol_HeaderHovered});
  set(glm::mix(p.raised, p.text, 0.22F), 1.0F, {ImGuiCol_FrameBgActive, ImGuiCol_ButtonActive, ImGuiCol_HeaderActive});
}

}  // namespace palpate
