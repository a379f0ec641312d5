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

// Draws the sliders that scale the rendered force.
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
  tip("Changes only the rendered force. Curves and figures show the unchanged models. J ends it.");
  ImGui::End();
  if (moved) session.use_scale({static_cast<double>(stiffness), static_cast<double>(damping)});
}

// Draws the title of the scene, and any exaggeration of force or picture.
void draw_title(const LiveSession& session, const ViewState& view, const UiStyle& style, const SceneArea& area) {
  ImGui::SetNextWindowPos({area.at.x + 2.0F, area.at.y + 2.0F});
  ImGui::Begin("title", nullptr, kFloating);
  ImGui::TextUnformatted(session.scene().title.c_str());
  tip(session.scene().description.c_str());
  if (!view.scales_force) {
    ImGui::SameLine(0.0F, ImGui::GetFontSize());
    ImGui::TextDisabled("dents x 2");
  }
  if (view.scales_force || view.exaggerated) {
    ImGui::SameLine(0.0F, ImGui::GetFontSize());
    ImGui::TextColored(paint(text_colour(kAboveJndColour, style.theme())), "%s",
                       view.scales_force ? scale_words(session.scale()).c_str() : "arrows: difference x 10");
  }
  ImGui::End();
}

// Draws the hint how to press, until the user has pressed with half a newton. Returns the y below it.
float draw_hint(const LiveSession& session, ViewState& view, const UiStyle& style, const SceneArea& area,
                float top_px) {
  constexpr double kPressed_N = 0.5;
  if (session.tool_input() == nullptr) return top_px;
  const bool alone = session.tool_input()->hand_is_exploring();
  if (!alone && session.newest().rendered_N > kPressed_N) view.has_pressed = true;
  if (!alone && view.has_pressed) return top_px;
  const std::string hint = alone ? "The hand moves by itself. Move the mouse down over the block to press it."
                                 : "Move the mouse down over the block to press it. No button is needed.";
  const float line = height_of(style.fonts().body);
  const float room = area.size.x - 1.8F * line;
  text_at(style.fonts().body, {area.at.x + 0.9F * line, top_px}, ink(style.colours().quiet), hint, room);
  return top_px + text_size(style.fonts().body, hint, room).y;
}

// Height of draw_buttons.
float buttons_height() { return ImGui::GetFrameHeight() + 2.0F * ImGui::GetStyle().WindowPadding.y; }

// Draws five buttons, and a menu of all other commands.
void draw_buttons(const SceneArea& area, const std::vector<WindowCommand>& commands) {
  ImGui::SetNextWindowPos({area.at.x + 2.0F, area.at.y + area.size.y - 2.0F}, ImGuiCond_Always, {0.0F, 1.0F});
  ImGui::Begin("buttons", nullptr, kFloating);
  for (const WindowCommand& command : commands) {
    if (!command.bar) continue;
    if (command_button(command)) command.run(0);
    ImGui::SameLine(0.0F, 4.0F);
  }
  if (ImGui::Button("Menu")) ImGui::OpenPopup("menu");
  tip("All other commands and their keys");
  if (ImGui::BeginPopup("menu")) {
    for (const WindowCommand& command : commands) {
      if (command.label.empty() || command.replay || command.bar) continue;
      const bool on = command.on && command.on();
      if (ImGui::MenuItem(shown_label(command).c_str(), shown_keys(command).c_str(), on)) command.run(0);
      tip(command.help.c_str());
    }
    ImGui::EndPopup();
  }
  ImGui::End();
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
  // The numbers are beside the sliders, because the grip would hide them.
  ImGui::SetNextItemWidth(0.40F * area.size.x);
  auto at_s = static_cast<float>(replay.playhead_s());
  if (ImGui::SliderFloat("##at", &at_s, 0.0F, static_cast<float>(replay.duration_s()), "")) {
    replay.seek(static_cast<double>(at_s));
  }
  tip("Position in the recording");
  ImGui::SameLine();
  ImGui::Text("%5.1f of %.1f s", replay.playhead_s(), replay.duration_s());
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-4.5F * ImGui::GetFontSize());
  auto speed = static_cast<float>(replay.speed());
  if (ImGui::SliderFloat("##speed", &speed, 0.05F, 10.0F, "", ImGuiSliderFlags_Logarithmic)) {
    replay.set_speed(static_cast<double>(speed));
  }
  tip("Speed of the replay");
  ImGui::SameLine();
  ImGui::Text("%.2f x", replay.speed());
  if (session.replay_test().found_m() != 0.0) {
    bool moved = session.replay_test().moved();
    const std::string label =
        "surface " + fixed(1e3 * session.replay_test().found_m(), 2) + " mm from that of the models; move it there";
    if (ImGui::Checkbox(label.c_str(), &moved)) session.move_surface(moved);
    tip("On: the surface is moved to where the models fit the recording best. Off: the positions are as recorded.");
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
  return "No such motion was recorded: here " + models.active()->name + " renders only its trend";
}

std::string recording_words(const RecordingStatus& recording) {
  if (!recording.active && !recording.saving) return {};
  const std::string name = std::filesystem::path(recording.path).filename().string();
  if (recording.saving) return "saving " + name;
  return "recording " + name + ": " + fixed(recording.seconds, 1) + " s, " + std::to_string(recording.rows) +
         " samples";
}

BigNumber big_number(const ModelsView& models, bool has_truth) {
  const ModelView* active = models.active();
  if (active == nullptr) {
    const auto fitting = std::find_if(models.slots.begin(), models.slots.end(),
                                      [](const ModelView& slot) { return slot.state == SlotState::fitting; });
    if (fitting == models.slots.end()) return {};
    return {fixed(100.0 * fitting->progress, 0) + " %", "of the first model, " + fitting->name,
            has_truth ? "until then only the true material has a force" : "until then there is no force", 0.0};
  }
  BigNumber big;
  const std::string& name = active->name;
  if (active->other_material) {
    big.below = models.counted;
  } else if (!models.compared) {
    const double guess = models.in_contact ? active->predicted_error_N / models.jnd.at(active->force_N) : std::nan("");
    if (!std::isnan(guess)) big.number = jnd_text(guess);
    big.below = name + ": 95 % bound of its error; " + models.reference_name;
    big.error_over_jnd = guess;
  } else if (models.selected == models.reference) {
    big.below = name + " is what the others are compared with";
  } else if (active->errors.samples == 0) {
    big.below = "the error of " + name + " from " + models.reference_name + ", from the next touch on";
  } else {
    big.error_over_jnd = active->errors.p99_error_over_jnd;
    big.number = jnd_text(big.error_over_jnd);
    big.below = "99 % of the time the error of " + name + " is below this";
  }
  return big;
}

std::string empty_scene_words(const LiveSession& session) {
  if (session.models().size() > 0 || session.replay() != nullptr) return {};
  return "No model yet, and no virtual material stands in for \"" + session.scene().title +
         "\".\nDrop a recording (CSV) here to fit it or to replay it, or a model file (M lists them).\n"
         "O chooses a scene with a material.";
}

std::optional<std::size_t> block_at(const WindowView& shown, const BlockView& blocks, const SceneArea& area,
                                    const ImVec2& point, bool aimed) {
  const std::size_t count = std::max<std::size_t>(shown.blocks.size(), 1);
  const auto half_height = 0.5F * static_cast<float>(blocks.geometry().height_m);
  const auto half_width = 0.5F * static_cast<float>(blocks.geometry().width_m);
  const glm::vec2 size(area.size.x, area.size.y);
  float nearest_px = 1e9F;
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec2 middle = blocks.on_screen(i, count, {0.0F, -half_height, 0.0F}, size);
    const glm::vec2 side = blocks.on_screen(i, count, {half_width, 0.0F, 0.0F}, size);
    const float away = std::hypot(area.at.x + middle.x - point.x, area.at.y + middle.y - point.y);
    if ((aimed && away > 1.25F * glm::length(side - middle)) || away > nearest_px) continue;
    nearest_px = away;
    found = i;
  }
  return found;
}

void draw_overlay(LiveSession& session, const WindowView& shown, const BlockView& blocks, ViewState& view,
                  const UiStyle& style, const SceneArea& area, const std::vector<Toast>& toasts,
                  const OverlayActions& actions) {
  const float line = height_of(style.fonts().body);
  const float buttons = view.exhibit.on ? 0.0F : std::max(buttons_height(), 2.4F * line);
  const float surface = session.replay_test().found_m() != 0.0 ? 1.7F * line : 0.0F;
  const float bars = buttons + (session.replay() != nullptr ? 2.4F * line + surface : 0.0F);
  float top_px = area.at.y + 2.0F * line;
  // The exhibit has its own texts.
  if (!view.exhibit.on) {
    draw_labels(shown, blocks, style, area, big_number_height(style, bars));
    if (!shown.models.slots.empty()) draw_big_number(shown, style, area, bars);
    draw_title(session, view, style, area);
    top_px = draw_headline(shown, style, area);
    draw_data_warning(shown.models, style, area, top_px);
    if (view.scales_force) draw_feel(session, style, area);
    if (!view.scales_force && data_warning(shown.models).empty())
      top_px = draw_hint(session, view, style, area, top_px);
  }
  draw_recording(session, style, area);
  draw_replay_bar(session, area, buttons, *actions.commands);
  if (!view.exhibit.on) draw_buttons(area, *actions.commands);
  if (!view.dialogs.recording_roles.any()) draw_device_words(session, style, area);
  draw_toasts(toasts, style, area, top_px + 0.5F * line);
  draw_file_picker(view, actions);
  draw_device_list(view, session.device_name(), actions);
  draw_scene_list(session, view, actions);
  draw_view_list(session, view, actions);
  draw_recording_roles(view, actions);
  draw_help(view, style, *actions.commands);
}

}  // namespace palpate
