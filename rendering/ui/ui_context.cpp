#include "rendering/ui/ui_context.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cfloat>

namespace palpate {

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

}  // namespace palpate
