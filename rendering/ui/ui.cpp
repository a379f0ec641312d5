#include "rendering/ui/ui.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <filesystem>
#include <glm/common.hpp>
#include <initializer_list>
#include <string_view>
#include <utility>

namespace palpate {
namespace {

// Font sizes for a window of 1080 lines.
constexpr float kHeading_px = 28.0F;
constexpr float kBig_px = 54.0F;
constexpr float kDesignHeight = 1080.0F;
// In a tall window the scale follows the width.
constexpr float kDesignWidth = 1500.0F;
constexpr float kLargestScale = 4.0F;
// The scale changes in steps, so that resizing a window does not rebuild the fonts in every frame.
constexpr float kScaleStep = 0.04F;

// DejaVu Sans and other fonts with tabular figures, at the paths of common distributions.
constexpr const char* kFontFiles[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf", "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf"};

// Latin letters and the signs that the panel uses.
constexpr ImWchar kGlyphs[] = {0x20, 0xFF, 0x2013, 0x2026, 0x2190, 0x2193, 0x25B2, 0x25BC, 0x3BC, 0x3C4, 0};

UiLayer layer_of(const ImDrawList& list) {
  const std::string_view owner = list._OwnerName != nullptr ? list._OwnerName : "";
  if (owner.rfind(kPanelWindow, 0) == 0) return UiLayer::panel;
  return owner.rfind(kOverPicture, 0) == 0 || owner == "##Background" ? UiLayer::over_picture : UiLayer::front;
}

// `flipped`: y points down in the framebuffer.
void draw_lists(UiLayer layer, ImDrawData data, bool flipped) {
  std::vector<ImDrawList*> lists(data.CmdLists, data.CmdLists + data.CmdListsCount);
  std::erase_if(lists, [&](const ImDrawList* list) { return layer_of(*list) != layer; });
  if (lists.empty()) return;
  const auto flip = [&] {
    for (ImDrawList* list : lists)
      for (ImDrawCmd& command : list->CmdBuffer) std::swap(command.ClipRect.y, command.ClipRect.w);
  };
  data.CmdLists = lists.data();
  data.CmdListsCount = static_cast<int>(lists.size());
  if (flipped) flip();
  ImGui_ImplOpenGL3_RenderDrawData(&data);
  if (flipped) flip();
}

}  // namespace

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
    ImFontConfig plain;
    plain.SizePixels = std::round(size_px * scale_ * pixels_per_unit_);
    ImFont* font = path.empty() ? io.Fonts->AddFontDefault(&plain)
                                : io.Fonts->AddFontFromFileTTF(path.c_str(), plain.SizePixels, nullptr, kGlyphs);
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

void UiContext::draw_layer(UiLayer layer, const ImVec2& at, const ImVec2& size) {
  ImDrawData data = *ImGui::GetDrawData();
  data.DisplayPos = {at.x, at.y + size.y};
  data.DisplaySize = {size.x, -size.y};
  data.FramebufferScale.y = -data.FramebufferScale.y;
  draw_lists(layer, data, true);
}

void UiContext::draw_front() { draw_lists(UiLayer::front, *ImGui::GetDrawData(), false); }

}  // namespace palpate
