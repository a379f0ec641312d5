// Windows and notices over the picture: the keys, model files, what the device wants.
#include <cctype>
#include <filesystem>

#include "rendering/panels/overlay_parts.h"
#include "rendering/panels/panel_parts.h"
#include "scenes/scene/assets.h"
#include "scenes/scene/scene.h"

namespace palpate::overlay {

void draw_plate(ImDrawList& list, const ImVec2& at, const ImVec2& size, const ImVec2& margin, ImU32 colour,
                std::optional<Rgb> stripe) {
  const ImVec2 low(at.x - margin.x, at.y - margin.y), high(at.x + size.x + margin.x, at.y + size.y + margin.y);
  list.AddRectFilled(low, high, colour, 6.0F);
  if (stripe) list.AddRectFilled(low, {at.x - 0.55F * margin.x, high.y}, ink(*stripe), 3.0F);
}

void begin_in_the_middle() {
  const ImVec2 all = ImGui::GetIO().DisplaySize;
  const float margin = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({0.5F * all.x, 0.5F * all.y}, ImGuiCond_Always, {0.5F, 0.5F});
  ImGui::SetNextWindowSizeConstraints({0.0F, 0.0F}, {all.x - margin, all.y - margin});
}

void draw_toasts(const std::vector<Toast>& toasts, const UiStyle& style, const SceneArea& area) {
  float y = area.at.y + 2.2F * height_of(style.fonts().heading);
  ImFont* font = style.fonts().body;
  const float pad = 0.6F * height_of(font);
  const float wrap = 0.86F * area.size.x;
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  for (const Toast& toast : toasts) {
    const ImVec2 size = font->CalcTextSizeA(height_of(font), 1e6F, wrap, toast.text.c_str());
    const float x = area.at.x + 0.5F * (area.size.x - size.x);
    draw_plate(list, {x, y}, size, {pad, pad}, ink(style.colours().raised),
               toast.problem ? style.colours().fault : kReferenceColour);
    list.AddText(font, height_of(font), {x, y}, ink(style.colours().text), toast.text.c_str(), nullptr, wrap);
    y += size.y + 2.6F * pad;
  }
}

void draw_data_warning(const LiveSession& session, const UiStyle& style, const SceneArea& area) {
  const std::string text = data_warning(models_view(session));
  if (text.empty()) return;
  const float wrap = 0.8F * area.size.x;
  const ImVec2 size = text_size(style.fonts().body, text, wrap);
  const float pad = 0.4F * height_of(style.fonts().body);
  const ImVec2 at(area.at.x + 0.5F * (area.size.x - size.x), area.at.y + 3.6F * height_of(style.fonts().heading));
  draw_plate(*ImGui::GetBackgroundDrawList(), at, size, {2.0F * pad, pad}, ink(style.colours().raised));
  text_at(style.fonts().body, at, ink(style.colours().text), text, wrap);
}

// What the device wants of whoever holds it, large and in the middle.
void draw_device_words(LiveSession& session, bool offered, const UiStyle& style, const SceneArea& area) {
  std::string words = offered ? std::string() : empty_scene_words(session);
  if (words.empty()) words = session.device_words();
  if (words.empty()) return;
  words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
  ImGui::SetNextWindowPos({area.at.x + 0.5F * area.size.x, area.at.y + 0.32F * area.size.y}, ImGuiCond_Always,
                          {0.5F, 0.5F});
  ImGui::SetNextWindowSize({0.8F * area.size.x, 0.0F});
  ImGui::Begin("device", nullptr, kFloating & ~ImGuiWindowFlags_NoBackground);
  ImGui::PushFont(style.fonts().heading);
  ImGui::TextWrapped("%s", words.c_str());
  ImGui::PopFont();
  if (session.newest().device.zeroing == Zeroing::needed && ImGui::Button("Zero here (Z)")) session.start_zeroing();
  ImGui::End();
}

void draw_help(ViewState& view, const UiStyle& style, const std::vector<WindowCommand>& commands) {
  if (!view.help) return;
  float keys = 0.0F;
  float text = 0.0F;
  for (const WindowCommand& command : commands) {
    keys = std::max(keys, ImGui::CalcTextSize(shown_keys(command).c_str()).x);
    text = std::max(text, ImGui::CalcTextSize(command.help.c_str()).x);
  }
  begin_in_the_middle();
  ImGui::SetNextWindowFocus();
  ImGui::Begin("Keys", &view.help, kDialog);
  // Beside each other where they are too many below each other.
  const ImVec2 all = ImGui::GetIO().DisplaySize;
  const float high = (static_cast<float>(commands.size()) + 3.0F) * ImGui::GetTextLineHeightWithSpacing();
  const std::size_t columns = high > all.y ? 2 : 1;
  const float room =
      (all.x - 4.0F * ImGui::GetFontSize()) / static_cast<float>(columns) - keys - 2.0F * ImGui::GetFontSize();
  const std::size_t rows = (commands.size() + columns - 1) / columns;
  if (ImGui::BeginTable("keys", 2 * static_cast<int>(columns), ImGuiTableFlags_NoSavedSettings)) {
    for (std::size_t column = 0; column < columns; ++column) {
      ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, keys + 0.5F * ImGui::GetFontSize());
      ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, std::min(text, room));
    }
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t i = row; i < commands.size(); i += rows) {
        ImGui::TableNextColumn();
        ImGui::TextColored(paint(style.colours().text), "%s", shown_keys(commands[i]).c_str());
        ImGui::TableNextColumn();
        ImGui::TextWrapped("%s", commands[i].help.c_str());
      }
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

void draw_scene_list(const LiveSession& session, ViewState& view, const OverlayActions& actions) {
  if (!view.scene_list) return;
  begin_in_the_middle();
  ImGui::Begin("Scenes", &view.scene_list, kDialog);
  const auto names = scene_names();
  for (const std::string& name : names ? *names : std::vector<std::string>{}) {
    const auto scene = load_scene(name);
    // A study is no scene to press.
    if (!scene || name == "jnd_study") continue;
    if (ImGui::Selectable((scene->title + "###" + name).c_str(), name == session.scene().name)) {
      view.scene_list = false;
      actions.use_scene(name);
    }
    tip(scene->description.c_str());
  }
  ImGui::End();
}

void draw_offered_recording(ViewState& view, const OverlayActions& actions) {
  if (!view.offered.any()) return;
  const OfferedFile offered = view.offered;
  bool open = true;
  begin_in_the_middle();
  ImGui::Begin(offered.problem.empty() ? "Recording" : "Not a recording", &open, kDialog);
  ImGui::PushTextWrapPos(std::min(0.8F * ImGui::GetIO().DisplaySize.x, 42.0F * ImGui::GetFontSize()));
  if (!offered.problem.empty()) {
    ImGui::TextUnformatted(offered.problem.c_str());
    ImGui::TextDisabled(
        "What it asks for is an option of `palpate import FILE --out REC.csv`; drop that recording here.");
  } else {
    ImGui::TextUnformatted(std::filesystem::path(offered.path).filename().c_str());
    for (const std::string& line : offered.words) ImGui::TextDisabled("%s", line.c_str());
    if (ImGui::Button("Fit it, and put it in my hand")) {
      actions.fit(offered.path);
      open = false;
    }
    tip("It becomes the material: all models are fitted to it in the background, and you press the best one");
    ImGui::SameLine();
    if (ImGui::Button("Replay it")) {
      open = false;
      actions.replay(offered.path);
    }
    tip("Moves the probe as it was recorded; the models are compared with the recorded force");
    ImGui::TextDisabled("%s", offered.path.c_str());
  }
  ImGui::PopTextWrapPos();
  ImGui::End();
  if (!open) view.offered = {};
}

}  // namespace palpate::overlay
