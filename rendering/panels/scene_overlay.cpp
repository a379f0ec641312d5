#include "rendering/panels/scene_overlay.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "engine/base/text.h"
#include "rendering/panels/overlay_parts.h"
#include "rendering/panels/panel_models.h"
#include "rendering/panels/panel_parts.h"
#include "rendering/ui/plot.h"

namespace palpate {
namespace {

using namespace overlay;

void draw_block_buttons(const LiveSession& session, ViewState& view) {
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
  if (view.feel) {
    ImGui::TextColored(paint(kAboveJndColour), "%s", scale_words(session.scale()).c_str());
  } else {
    ImGui::TextDisabled("blocks, dents x 2");
  }
}

// How the active model is felt; the title says so.
void draw_feel(LiveSession& session, const UiStyle& style, const SceneArea& area) {
  ImGui::SetNextWindowPos({area.at.x + 2.0F, area.at.y + 2.4F * height_of(style.fonts().heading)});
  ImGui::Begin("feel", nullptr, kFloating);
  auto stiffness = static_cast<float>(session.scale().stiffness);
  auto damping = static_cast<float>(session.scale().damping_Ns_per_m);
  ImGui::PushItemWidth(0.28F * area.size.x);
  bool moved = ImGui::SliderFloat("stiffness", &stiffness, static_cast<float>(ForceScale::kLeast),
                                  static_cast<float>(ForceScale::kMost), "x %.2f",
                                  ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  moved = ImGui::SliderFloat("damping", &damping, 0.0F, static_cast<float>(ForceScale::kMostDamping_Ns_per_m),
                             "+ %.1f N s/m", ImGuiSliderFlags_AlwaysClamp) ||
          moved;
  ImGui::PopItemWidth();
  tip("In the hand alone: curves and figures are of the models as they are. J ends it.");
  ImGui::End();
  if (moved) session.use_scale({static_cast<double>(stiffness), static_cast<double>(damping)});
}

void draw_title(const LiveSession& session, ViewState& view, const UiStyle& style, const SceneArea& area) {
  ImGui::SetNextWindowPos({area.at.x + 2.0F, area.at.y + 2.0F});
  ImGui::Begin("title", nullptr, kFloating);
  ImGui::PushFont(style.fonts().heading);
  ImGui::TextUnformatted(session.scene().title.c_str());
  ImGui::PopFont();
  tip(session.scene().description.c_str());
  draw_block_buttons(session, view);
  if (view.exaggerated) {
    ImGui::SameLine(0.0F, ImGui::GetFontSize());
    ImGui::TextColored(paint(kAboveJndColour), "arrows: difference x 10");
  }
  ImGui::End();
}

// Until it was done: half a newton felt by whoever moves the mouse.
void draw_hint(const LiveSession& session, ViewState& view, const UiStyle& style, const SceneArea& area) {
  constexpr double kPressed_N = 0.5;
  if (session.mouse() == nullptr) return;
  const bool alone = session.mouse()->hand_is_exploring();
  if (!alone && session.newest().rendered_N > kPressed_N) view.has_pressed = true;
  if (!alone && view.has_pressed) return;
  const std::string hint = alone ? "The hand moves by itself. Move the mouse down over the block to press it."
                                 : "Move down over the block to press: no button, only the way of the mouse.";
  const float line = height_of(style.fonts().body);
  text_at(style.fonts().body,
          {area.at.x + 0.9F * line, area.at.y + 2.6F * height_of(style.fonts().heading) - 0.6F * line},
          ink(style.colours().quiet), hint, area.size.x - 1.8F * line);
}

// In as many rows as it takes. Returns how high it is.
float draw_buttons(const SceneArea& area, const std::vector<WindowCommand>& commands) {
  ImGui::SetNextWindowPos({area.at.x + 2.0F, area.at.y + area.size.y - 2.0F}, ImGuiCond_Always, {0.0F, 1.0F});
  ImGui::Begin("buttons", nullptr, kFloating);
  bool first = true;
  for (const WindowCommand& command : commands) {
    if (command.label.empty() || command.replay) continue;
    const float width = ImGui::CalcTextSize(shown_label(command).c_str()).x + 2.0F * ImGui::GetStyle().FramePadding.x;
    constexpr float kGap = 4.0F;
    const bool fits = ImGui::GetItemRectMax().x + kGap + width < area.at.x + area.size.x - kGap;
    if (!first && fits) ImGui::SameLine(0.0F, kGap);
    first = false;
    if (command_button(command)) command.run(0);
  }
  const float height = ImGui::GetWindowSize().y;
  ImGui::End();
  return height;
}

void draw_replay_bar(LiveSession& session, const SceneArea& area, float lift,
                     const std::vector<WindowCommand>& commands) {
  if (session.replay() == nullptr) return;
  ReplayControl& replay = *session.replay();
  ImGui::SetNextWindowPos({area.at.x + 2.0F, area.at.y + area.size.y - lift}, ImGuiCond_Always, {0.0F, 1.0F});
  ImGui::SetNextWindowSize({area.size.x - 4.0F, 0.0F});
  ImGui::Begin("replay", nullptr, kFloating & ~ImGuiWindowFlags_AlwaysAutoResize);
  for (const WindowCommand& command : commands) {
    if (command.label.empty() || !command.replay) continue;
    if (command_button(command)) command.run(0);
    ImGui::SameLine();
  }
  // Figures beside the sliders: on them the grip hides what it is dragged over.
  ImGui::SetNextItemWidth(0.40F * area.size.x);
  auto at_s = static_cast<float>(replay.playhead_s());
  if (ImGui::SliderFloat("##at", &at_s, 0.0F, static_cast<float>(replay.duration_s()), "")) {
    replay.seek(static_cast<double>(at_s));
  }
  tip("Where in the recording");
  ImGui::SameLine();
  ImGui::Text("%5.1f of %.1f s", replay.playhead_s(), replay.duration_s());
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-4.5F * ImGui::GetFontSize());
  auto speed = static_cast<float>(replay.speed());
  if (ImGui::SliderFloat("##speed", &speed, 0.05F, 10.0F, "", ImGuiSliderFlags_Logarithmic)) {
    replay.set_speed(static_cast<double>(speed));
  }
  tip("Its speed");
  ImGui::SameLine();
  ImGui::Text("%.2f x", replay.speed());
  if (session.surface().found_m() != 0.0) {
    bool moved = session.surface().moved();
    const std::string label =
        "surface " + fixed(1e3 * session.surface().found_m(), 2) + " mm from the models'; moved there";
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
  ImGui::GetBackgroundDrawList()->AddCircleFilled({at.x - 0.7F * size.y, at.y + 0.55F * size.y}, 0.35F * size.y,
                                                  ink(style.colours().text));
  text_at(style.fonts().body, at, ink(style.colours().text), text);
}

}  // namespace

std::string scale_words(const ForceScale& scale) {
  return "in the hand: stiffness x " + fixed(scale.stiffness, 2) + ", damping + " + fixed(scale.damping_Ns_per_m, 1);
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

BigNumber big_number(const ModelsView& models, const JndLine& jnd) {
  const SlotView* active = models.active();
  if (active == nullptr) {
    const auto fitting = std::find_if(models.slots.begin(), models.slots.end(),
                                      [](const SlotView* slot) { return slot->state == SlotState::fitting; });
    if (fitting == models.slots.end()) return {};
    return {fixed(100.0 * (*fitting)->progress, 0) + " %", "of the first model, " + (*fitting)->name + ":",
            "until then the true material answers alone", 0.0};
  }
  const std::string& name = active->name;
  if (active->foreign) return {"–", "of what a hand can notice:", counted_words(models), 0.0};
  if (!models.compared) {
    const double guess = models.in_contact ? active->predicted_error_N / jnd.at(active->force_N) : std::nan("");
    return {std::isnan(guess) ? "–" : jnd_text(guess),
            "of what a hand can notice:", name + "'s own guess (95 %); " + models.off_from, guess};
  }
  if (models.selected == models.reference)
    return {"–", "of what a hand can notice:", name + " is what the others are compared with", 0.0};
  const std::string what = name + " off " + models.off_from;
  if (active->errors.samples() == 0) return {"–", "of what a hand can notice:", what + ": from the next touch on", 0.0};
  const double error = active->quantile.p99();
  return {jnd_text(error), "of what a hand can notice:", what + ", 99 % of the time", error};
}

std::string empty_scene_words(const LiveSession& session) {
  if (session.models().size() > 0 || session.replay() != nullptr) return {};
  return "No model yet, and no virtual material stands in for \"" + session.scene().title +
         "\".\nDrop a recording (CSV) here to fit it or to replay it, or a model file (M lists them).\n"
         "O chooses a scene with a material.";
}

std::vector<std::size_t> shown_slots(const LiveSession& session, std::size_t block_count) {
  const ReferenceKind kind = session.comparison().reference();
  const bool reference = block_count > 1 && kind != ReferenceKind::direct && session.has_reference(kind);
  const std::size_t room = reference ? block_count - 1 : block_count;
  const ModelsView models = models_view(session);
  std::vector<std::size_t> slots;
  for (std::size_t i = 0; i < models.slots.size() && slots.size() < room; ++i) {
    if (models.slots[i]->state == SlotState::ready) slots.push_back(i);
  }
  const bool missing =
      models.active() != nullptr && std::find(slots.begin(), slots.end(), models.selected) == slots.end();
  if (missing && !slots.empty()) slots.back() = models.selected;
  if (reference) slots.push_back(kReferenceBlock);
  return slots;
}

std::optional<std::size_t> SceneOverlay::slot_at(const LiveSession& session, const BlockView& blocks,
                                                 const ViewState& view, const SceneArea& area,
                                                 const ImVec2& point) const {
  const std::vector<std::size_t> slots = shown_slots(session, view.block_count);
  float nearest_px = 1e9F;
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const glm::vec2 middle =
        blocks.on_screen(i, slots.size(), {0.0F, -0.5F * static_cast<float>(blocks.geometry().height_m), 0.0F},
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
                        const SceneArea& area, const std::vector<Toast>& toasts, const OverlayActions& actions) {
  const float line = height_of(style.fonts().body);
  const float buttons = view.exhibit ? 0.0F : std::max(buttons_height_, 2.4F * line);
  const float surface = session.surface().found_m() != 0.0 ? 1.7F * line : 0.0F;
  const float bars = buttons + (session.replay() != nullptr ? 2.4F * line + surface : 0.0F);
  // An exhibit has names of its own.
  if (!view.exhibit) draw_labels(session, blocks, view, style, area, big_number_height(style, bars));
  if (!view.exhibit && session.models().size() > 0) draw_big_number(session, style, area, bars);
  if (!view.exhibit) draw_data_warning(session, style, area);
  if (!view.exhibit) draw_title(session, view, style, area);
  if (view.feel) draw_feel(session, style, area);
  if (!view.exhibit && !view.feel) draw_hint(session, view, style, area);
  draw_recording(session, style, area);
  draw_replay_bar(session, area, buttons, *actions.commands);
  if (!view.exhibit) buttons_height_ = draw_buttons(area, *actions.commands);
  draw_device_words(session, view.offered.any(), style, area);
  draw_toasts(toasts, style, area);
  draw_file_picker(view, actions);
  draw_device_list(view, session.device_name(), actions);
  draw_scene_list(session, view, actions);
  draw_offered_recording(view, actions);
  draw_help(view, style, *actions.commands);
}

}  // namespace palpate
