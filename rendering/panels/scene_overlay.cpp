#include "rendering/panels/scene_overlay.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <string>

#include "engine/base/text.h"
#include "rendering/panels/panel_parts.h"
#include "rendering/panels/panel_views.h"
#include "rendering/ui/plot.h"
#include "scenes/scene/assets.h"

namespace palpate {
namespace {

constexpr auto kFloating = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                           ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBackground |
                           ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing |
                           ImGuiWindowFlags_NoNav;

ImDrawList& back() { return *ImGui::GetBackgroundDrawList(); }

void text_at(ImFont* font, const ImVec2& at, ImU32 colour, const std::string& text) {
  back().AddText(font, font->FontSize, at, colour, text.c_str());
}

ImVec2 text_size(ImFont* font, const std::string& text) {
  return font->CalcTextSizeA(font->FontSize, 1e6F, 0.0F, text.c_str());
}

// Top left corner of block `index`'s label: at its foot; of a block with another one
// before it, over its tool; of a single block, in the picture's upper right corner,
// where nothing else is.
ImVec2 label_place(const BlockView& blocks, std::size_t index, std::size_t count, const SceneArea& area,
                   const ImVec2& size) {
  if (count == 1) return {area.at.x + area.size.x - 1.15F * size.x - size.y, area.at.y + 2.6F * size.y};
  const bool behind = count == 4 && index < 2;
  if (behind) {
    // The tool's length and a little more, for it is lifted between presses.
    const auto above = 16.0F * static_cast<float>(blocks.geometry().tool_radius_m);
    const glm::vec2 top = blocks.on_screen(index, count, {0.0F, above, 0.0F}, {area.size.x, area.size.y});
    const float x = std::clamp(top.x - 0.5F * size.x, 4.0F, area.size.x - size.x - 4.0F);
    return {area.at.x + x, area.at.y + std::max(3.0F * size.y, top.y - 1.9F * size.y)};
  }
  const auto half = 0.5F * static_cast<float>(blocks.geometry().length_m);
  const auto height = static_cast<float>(blocks.geometry().height_m);
  // Before the block's front side, on the table's edge of it.
  const glm::vec2 front = blocks.on_screen(index, count, {0.35F * half, -1.02F * height, 1.0F * half},
                                           {area.size.x, area.size.y});
  const float x = std::clamp(front.x - 0.5F * size.x, 4.0F, area.size.x - size.x - 4.0F);
  const float y = std::clamp(front.y + 0.25F * size.y, 4.0F, area.size.y - size.y - 4.0F);
  return {area.at.x + x, area.at.y + y};
}

std::string label_text(const LiveSession& session, std::size_t slot) {
  return std::to_string(slot + 1) + "  " + session.models().view(slot).name;
}

void draw_labels(const LiveSession& session, const BlockView& blocks, const ViewState& view,
                 const UiStyle& style, const SceneArea& area) {
  const std::vector<std::size_t> slots = shown_slots(session, view.block_count);
  ImFont* font = style.fonts().heading;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const SlotView& slot = session.models().view(slots[i]);
    const bool secret = view.hidden_choice > 0;
    const std::string text =
        secret ? "block " + std::to_string(view.hidden_choice) : label_text(session, slots[i]);
    const ImVec2 size = text_size(font, text);
    const ImVec2 at = label_place(blocks, i, slots.size(), area, size);
    const bool chosen = slots[i] == session.models().selected();
    const Rgb colour = secret ? style.colours().text : method_colour(slot.method, style.theme());
    const float pad = 0.25F * font->FontSize;
    back().AddRectFilled({at.x - 2.0F * pad, at.y - 0.5F * pad},
                         {at.x + size.x + 2.0F * pad, at.y + size.y + 0.5F * pad},
                         ink(style.colours().panel, 0.88F), 6.0F);
    back().AddRectFilled({at.x - 2.0F * pad, at.y - 0.5F * pad},
                         {at.x - 1.0F * pad, at.y + size.y + 0.5F * pad}, ink(colour), 3.0F);
    text_at(font, at, ink(chosen ? style.colours().text : style.colours().quiet), text);
    if (slots.size() < 2 || !chosen) continue;
    const std::string active = "active model";
    const ImVec2 below = text_size(style.fonts().body, active);
    text_at(style.fonts().body, {at.x + 0.5F * (size.x - below.x), at.y + size.y + 0.6F * pad},
            ink(style.colours().text), active);
  }
}

// The big number, in words, and the scale that its colour is from.
void draw_big_number(const LiveSession& session, const UiStyle& style, const SceneArea& area, float lift) {
  const Palette& p = style.colours();
  ImFont* big = style.fonts().big;
  ImFont* body = style.fonts().body;
  const float line = body->FontSize;
  const ImVec2 corner(area.at.x + 1.1F * line, area.at.y + area.size.y - lift);
  const ModelsView models = models_view(session);
  const SlotView* active = models.active();
  const double error = active != nullptr && !std::isnan(session.comparison().reference_N())
                           ? active->recent_peak_error_over_jnd
                           : 0.0;
  const std::string number = peak_error_words(models, session.comparison().reference_N());
  const ImVec2 size = text_size(big, "0.00");
  const float y = corner.y - size.y - 1.9F * line;
  text_at(big, {corner.x, y}, ink(error > 1.0 ? kAboveJndColour : p.text), number);
  const float beside = corner.x + size.x + 0.7F * line;
  text_at(body, {beside, y + 0.30F * size.y}, ink(p.text), "of what a hand can notice:");
  text_at(body, {beside, y + 0.30F * size.y + 1.15F * line}, ink(p.quiet),
          "the error of the active model");
  const float width = 11.0F * line;
  const float top = y + size.y + 0.35F * line;
  const float high = 0.55F * line;
  for (int i = 0; i < 40; ++i) {
    const float from = static_cast<float>(i) / 40.0F;
    back().AddRectFilled({corner.x + from * width, top},
                         {corner.x + (from + 0.025F) * width + 0.5F, top + high},
                         ink(error_colour(static_cast<double>(from))));
  }
  back().AddRectFilled({corner.x + width + 3.0F, top}, {corner.x + 1.3F * width, top + high},
                       ink(kAboveJndColour));
  text_at(body, {corner.x, top + high + 1.0F}, ink(p.quiet), "0");
  text_at(body, {corner.x + width - 0.3F * line, top + high + 1.0F}, ink(p.quiet), "1");
  text_at(body, {corner.x + width + 1.0F * line, top + high + 1.0F}, ink(p.quiet), "error / JND");
}

void draw_block_buttons(ViewState& view) {
  ImGui::SameLine(0.0F, 2.0F * ImGui::GetFontSize());
  for (const std::size_t count : {1U, 2U, 4U}) {
    ImGui::SameLine();
    const bool on = view.block_count == count;
    if (on) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyle().Colors[ImGuiCol_ButtonActive]);
    if (ImGui::Button(std::to_string(count).c_str())) view.block_count = count;
    if (on) ImGui::PopStyleColor();
    tip("Blocks side by side, each with its own model under the same probe (B)");
  }
  ImGui::SameLine();
  ImGui::TextDisabled("blocks");
}

void draw_title(const LiveSession& session, ViewState& view, const UiStyle& style, const SceneArea& area) {
  ImGui::SetNextWindowPos({area.at.x + 2.0F, area.at.y + 2.0F});
  ImGui::Begin("title", nullptr, kFloating);
  ImGui::PushFont(style.fonts().heading);
  ImGui::TextUnformatted(session.scene().title.c_str());
  ImGui::PopFont();
  tip(session.scene().description.c_str());
  if (!view.kiosk) draw_block_buttons(view);
  ImGui::End();
}

void draw_hint(const LiveSession& session, const UiStyle& style, const SceneArea& area) {
  if (session.mouse() == nullptr || !session.mouse()->hand_is_exploring()) return;
  const std::string hint = "The hand moves by itself. Move the mouse over the block to press it.";
  const ImVec2 size = text_size(style.fonts().body, hint);
  text_at(style.fonts().body,
          {area.at.x + 0.9F * style.fonts().body->FontSize,
           area.at.y + 2.6F * style.fonts().heading->FontSize - 0.6F * size.y},
          ink(style.colours().quiet), hint);
}

void draw_buttons(const LiveSession& session, const ViewState& view, const SceneArea& area,
                  const std::function<void(Command)>& run) {
  ImGui::SetNextWindowPos({area.at.x + 2.0F, area.at.y + area.size.y - 2.0F}, ImGuiCond_Always, {0.0F, 1.0F});
  ImGui::Begin("buttons", nullptr, kFloating);
  bool first = true;
  for (const CommandEntry& entry : commands()) {
    if (*entry.label == '\0') continue;
    if (!first) ImGui::SameLine(0.0F, 4.0F);
    first = false;
    std::string label = entry.label;
    if (entry.command == Command::record && session.recording().active) label = "Stop recording";
    if (entry.command == Command::pause_curves && view.paused) label = "Go on";
    if (ImGui::Button(label.c_str())) run(entry.command);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s (%s)", entry.help, entry.key);
  }
  ImGui::End();
}

void draw_replay_bar(LiveSession& session, const SceneArea& area, float lift) {
  if (session.replay() == nullptr) return;
  ReplayControl& replay = *session.replay();
  ImGui::SetNextWindowPos({area.at.x + 2.0F, area.at.y + area.size.y - lift}, ImGuiCond_Always, {0.0F, 1.0F});
  ImGui::SetNextWindowSize({area.size.x - 4.0F, 0.0F});
  ImGui::Begin("replay", nullptr, kFloating & ~ImGuiWindowFlags_AlwaysAutoResize);
  if (ImGui::Button(replay.paused() ? "Play" : "Pause")) replay.pause(!replay.paused());
  tip("The recording (P)");
  ImGui::SameLine();
  // Figures beside the sliders: on them the grip hides what it is dragged over.
  ImGui::SetNextItemWidth(0.50F * area.size.x);
  auto at_s = static_cast<float>(replay.playhead_s());
  if (ImGui::SliderFloat("##at", &at_s, 0.0F, static_cast<float>(replay.duration_s()), "")) {
    replay.seek(static_cast<double>(at_s));
  }
  tip("Where in the recording ([ and ] by 2 s)");
  ImGui::SameLine();
  ImGui::Text("%5.1f of %.1f s", replay.playhead_s(), replay.duration_s());
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-4.5F * ImGui::GetFontSize());
  auto speed = static_cast<float>(replay.speed());
  if (ImGui::SliderFloat("##speed", &speed, 0.05F, 10.0F, "", ImGuiSliderFlags_Logarithmic)) {
    replay.set_speed(static_cast<double>(speed));
  }
  tip("Its speed (, and .)");
  ImGui::SameLine();
  ImGui::Text("%.2f x", replay.speed());
  if (session.surface().found_m() != 0.0) {
    bool moved = session.surface().moved();
    const std::string label = "surface " + fixed(1e3 * session.surface().found_m(), 2) + " mm from the models'; moved there";
    if (ImGui::Checkbox(label.c_str(), &moved)) session.move_surface(moved);
    tip("Where the forces of the models fit the recording best; off: positions as recorded");
  }
  ImGui::End();
}

void draw_recording(const LiveSession& session, const UiStyle& style, const SceneArea& area) {
  const RecordingStatus recording = session.recording();
  if (!recording.active && !recording.saving) return;
  const std::string text = recording_words(recording);
  const ImVec2 size = text_size(style.fonts().body, text);
  const ImVec2 at(area.at.x + area.size.x - size.x - size.y, area.at.y + 0.9F * size.y);
  back().AddCircleFilled({at.x - 0.7F * size.y, at.y + 0.55F * size.y}, 0.35F * size.y,
                         ink(style.colours().text));
  text_at(style.fonts().body, at, ink(style.colours().text), text);
}

void draw_toasts(const std::vector<Toast>& toasts, const UiStyle& style, const SceneArea& area) {
  float y = area.at.y + 4.6F * style.fonts().heading->FontSize;
  ImFont* font = style.fonts().body;
  const float pad = 0.6F * font->FontSize;
  const float wrap = 0.86F * area.size.x;
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  for (const Toast& toast : toasts) {
    const ImVec2 size = font->CalcTextSizeA(font->FontSize, 1e6F, wrap, toast.text.c_str());
    const float x = area.at.x + 0.5F * (area.size.x - size.x);
    list.AddRectFilled({x - pad, y - pad}, {x + size.x + pad, y + size.y + pad}, ink(style.colours().raised),
                       6.0F);
    list.AddRectFilled({x - pad, y - pad}, {x - 0.6F * pad, y + size.y + pad},
                       ink(toast.problem ? style.colours().fault : kReferenceColour), 3.0F);
    list.AddText(font, font->FontSize, {x, y}, ink(style.colours().text), toast.text.c_str(), nullptr, wrap);
    y += size.y + 2.6F * pad;
  }
}

void draw_data_warning(const LiveSession& session, const UiStyle& style, const SceneArea& area) {
  const std::string text = data_warning(models_view(session));
  if (text.empty()) return;
  const ImVec2 size = text_size(style.fonts().body, text);
  const float pad = 0.4F * size.y;
  const ImVec2 at(area.at.x + 0.5F * (area.size.x - size.x), area.at.y + 4.2F * size.y);
  back().AddRectFilled({at.x - 2.0F * pad, at.y - pad}, {at.x + size.x + 2.0F * pad, at.y + size.y + pad},
                       ink(style.colours().raised), 6.0F);
  text_at(style.fonts().body, at, ink(style.colours().text), text);
}

// What the device wants of whoever holds it, large and in the middle.
void draw_device_words(LiveSession& session, const UiStyle& style, const SceneArea& area) {
  std::string words = session.device_words();
  if (words.empty()) return;
  words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
  ImGui::SetNextWindowPos({area.at.x + 0.5F * area.size.x, area.at.y + 0.32F * area.size.y}, ImGuiCond_Always,
                          {0.5F, 0.5F});
  ImGui::SetNextWindowSize({0.8F * area.size.x, 0.0F});
  ImGui::Begin("device", nullptr, kFloating & ~ImGuiWindowFlags_NoBackground);
  ImGui::PushFont(style.fonts().heading);
  ImGui::TextWrapped("%s", words.c_str());
  ImGui::PopFont();
  if (session.newest().device.zeroing == Zeroing::needed && ImGui::Button("Zero here (Z)"))
    session.start_zeroing();
  ImGui::End();
}

void draw_help(ViewState& view, const UiStyle& style, const SceneArea& area) {
  if (!view.help) return;
  ImGui::SetNextWindowPos({area.at.x + 0.5F * area.size.x, area.at.y + 0.5F * area.size.y}, ImGuiCond_Always,
                          {0.5F, 0.5F});
  ImGui::SetNextWindowFocus();
  ImGui::Begin("Keys", &view.help,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove);
  const auto line = [&](const char* key, const char* text) {
    ImGui::TextColored(paint(style.colours().text), "%s", key);
    ImGui::SameLine(9.5F * ImGui::GetFontSize());
    ImGui::TextUnformatted(text);
  };
  line("mouse", "moves the probe, over the block; down is deeper");
  line("wheel, Up, Down", "move the probe step by step");
  line("right button", "turns the view; Ctrl + wheel comes nearer");
  line("1 ... 9", "make a model the active one; a click on its block too");
  for (const CommandEntry& entry : commands()) line(entry.key, entry.help);
  line("Left, Right", "scroll back and forth while the curves stand still");
  line("P [ ] , .", "pause, seek, speed of a replayed recording");
  line("drop a file", "loads a model");
  line("Ctrl+Q", "ends the program");
  ImGui::End();
}

void draw_file_list(LiveSession& session, ViewState& view, const SceneArea& area) {
  if (!view.file_list) return;
  ImGui::SetNextWindowPos({area.at.x + 0.5F * area.size.x, area.at.y + 0.5F * area.size.y}, ImGuiCond_Always,
                          {0.5F, 0.5F});
  ImGui::Begin("Load a model", &view.file_list,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove);
  ImGui::TextUnformatted("Drop a model file onto the window, or choose one:");
  bool any = false;
  const auto assets = find_assets();
  for (const std::string& folder :
       {assets ? *assets + "/models" : std::string(), std::string("."), std::string("build/run")}) {
    std::error_code missing;
    if (folder.empty()) continue;
    for (const auto& entry : std::filesystem::directory_iterator(folder, missing)) {
      if (entry.path().extension() != ".json") continue;
      any = true;
      if (ImGui::Selectable(entry.path().c_str())) {
        session.load_file(entry.path().string());
        view.file_list = false;
      }
    }
  }
  if (!any)
    ImGui::TextDisabled("no .json file in assets/models, here or in build/run; `palpate fit` makes one");
  ImGui::End();
}

}  // namespace

const std::vector<CommandEntry>& commands() {
  static const std::vector<CommandEntry> all = {
      {Command::help, "H", "Help", "all keys"},
      {Command::record, "R", "Record", "record this session to a file that `palpate fit` reads"},
      {Command::pause_curves, "Space", "Stop", "stop the curves to look back, and go on"},
      {Command::reset_figures, "C", "Clear", "forget the errors so far, and alarms that were seen"},
      {Command::next_reference, "F", "Reference", "choose what the models are compared with"},
      {Command::file_list, "M", "Load", "load a model file"},
      {Command::zero, "Z", "", "the device's tool is at its rest position: zero it there"},
      {Command::dead_man, "D", "",
       "push only while G, then while the handle's switch is held, and off again"},
      {Command::theme, "T", "Theme", "light or dark"},
      {Command::details, "L", "Loop", "all figures of the loop, and its faults"},
      {Command::next_block_count, "B", "", "one, two or four blocks side by side"},
      {Command::fullscreen, "F11", "", "full screen and back"},
  };
  return all;
}

std::string data_warning(const ModelsView& models) {
  if (!models.out_of_domain()) return {};
  return "Nothing like this was recorded: here " + models.active()->name + " only follows the trend";
}

std::string recording_words(const RecordingStatus& recording) {
  if (!recording.active && !recording.saving) return {};
  const std::string name = std::filesystem::path(recording.path).filename().string();
  if (recording.saving) return "saving " + name;
  char length[64];
  std::snprintf(length, sizeof length, ": %.1f s, %llu samples", recording.seconds,
                static_cast<unsigned long long>(recording.rows));
  return "recording " + name + length;
}

std::string peak_error_words(const ModelsView& models, double reference_N) {
  const SlotView* active = models.active();
  if (active == nullptr || std::isnan(reference_N)) return "–";
  const double error = active->recent_peak_error_over_jnd;
  // Two decimals are more than anyone can see change.
  return error < 0.9995 ? at_most_three_decimals(error).substr(0, 4) : at_most_three_decimals(error);
}

std::vector<std::size_t> shown_slots(const LiveSession& session, std::size_t block_count) {
  std::vector<std::size_t> slots;
  for (std::size_t i = 0; i < session.models().size() && slots.size() < block_count; ++i) {
    if (session.models().view(i).state == SlotState::ready) slots.push_back(i);
  }
  if (slots.size() == 3) slots.pop_back();  // one, two or four
  const bool selectable =
      session.models().size() > 0 && session.models().view(session.models().selected()).state == SlotState::ready;
  if (selectable && std::find(slots.begin(), slots.end(), session.models().selected()) == slots.end() &&
      !slots.empty()) {
    slots.back() = session.models().selected();
  }
  return slots;
}

std::optional<std::size_t> SceneOverlay::slot_at(const LiveSession& session, const BlockView& blocks,
                                                 const ViewState& view, const SceneArea& area,
                                                 const ImVec2& point) const {
  const std::vector<std::size_t> slots = shown_slots(session, view.block_count);
  float nearest_px = 1e9F;
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const glm::vec2 middle = blocks.on_screen(
        i, slots.size(), {0.0F, -0.5F * static_cast<float>(blocks.geometry().height_m), 0.0F},
        {area.size.x, area.size.y});
    const glm::vec2 side =
        blocks.on_screen(i, slots.size(), {0.5F * static_cast<float>(blocks.geometry().width_m), 0.0F, 0.0F},
                         {area.size.x, area.size.y});
    const float away = std::hypot(area.at.x + middle.x - point.x, area.at.y + middle.y - point.y);
    if (away > 1.25F * glm::length(side - middle) || away > nearest_px) continue;
    nearest_px = away;
    found = slots[i];
  }
  return found;
}

void SceneOverlay::draw(LiveSession& session, const BlockView& blocks, ViewState& view, const UiStyle& style,
                        const SceneArea& area, const std::vector<Toast>& toasts,
                        const std::function<void(Command)>& run) {
  const float line = style.fonts().body->FontSize;
  const float buttons = 2.4F * line;
  const float surface = session.surface().found_m() != 0.0 ? 1.7F * line : 0.0F;
  const float bars = buttons + (session.replay() != nullptr ? 2.4F * line + surface : 0.0F);
  // Who only passes by needs no model's name.
  const bool passing = view.kiosk && session.mouse() != nullptr && session.mouse()->hand_is_exploring();
  if (!passing) draw_labels(session, blocks, view, style, area);
  if (view.hidden_choice == 0) draw_big_number(session, style, area, bars);
  draw_data_warning(session, style, area);
  draw_title(session, view, style, area);
  if (!view.kiosk) draw_hint(session, style, area);
  draw_recording(session, style, area);
  draw_replay_bar(session, area, buttons);
  if (!view.kiosk) draw_buttons(session, view, area, run);
  draw_device_words(session, style, area);
  draw_toasts(toasts, style, area);
  draw_file_list(session, view, area);
  draw_help(view, style, area);
}

}  // namespace palpate
