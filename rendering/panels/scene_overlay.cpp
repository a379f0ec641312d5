#include "rendering/panels/scene_overlay.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "engine/base/text.h"
#include "rendering/panels/panel_parts.h"

namespace palpate {
namespace {

constexpr auto kFloating = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                           ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_AlwaysAutoResize |
                           ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

// The overlay of a frame. `lift` in its functions: height of other parts at the lower edge of the area.
struct Overlay {
  LiveSession& session;
  const WindowView& shown;
  const BlockView& blocks;
  ViewState& view;
  const UiStyle& style;
  const SceneArea& area;
  const std::vector<WindowCommand>& commands;

  const ModelsView& models() const { return shown.models; }
  const Palette& colours() const { return style.colours(); }
  const Fonts& fonts() const { return style.fonts(); }
  float line() const { return height_of(fonts().body); }
  ImDrawList& list() const { return *ImGui::GetBackgroundDrawList(); }
  ImU32 text_ink(bool quiet) const { return ink(quiet ? colours().quiet : colours().text); }

  // Draws a plate with a margin behind text at `at` of `size`, and a coloured stripe at its left.
  static void draw_plate(ImDrawList& list, const ImVec2& at, const ImVec2& size, const ImVec2& margin, ImU32 colour,
                         ImU32 stripe) {
    const ImVec2 low(at.x - margin.x, at.y - margin.y), high(at.x + size.x + margin.x, at.y + size.y + margin.y);
    list.AddRectFilled(low, high, colour, 6.0F);
    list.AddRectFilled(low, {at.x - 0.55F * margin.x, high.y}, stripe, 3.0F);
  }

  // Draws text that is wrapped to the width `room`. Returns the y below it.
  static float draw_wrapped(ImFont* font, const ImVec2& at, const std::string& text, ImU32 colour, float room) {
    text_at(font, at, colour, text, room);
    return at.y + text_size(font, text, room).y;
  }

  // Draws the sliders that scale the rendered force. Returns the y below them.
  float draw_feel(float top_px) const {
    ImGui::SetNextWindowPos({area.at.x + 2.0F, top_px});
    ImGui::Begin("feel", nullptr, kFloating);
    auto stiffness = static_cast<float>(session.controls().scale.stiffness);
    auto damping = static_cast<float>(session.controls().scale.damping_Ns_per_m);
    ImGui::PushItemWidth(0.28F * area.size.x);
    bool moved = ImGui::SliderFloat("stiffness", &stiffness, static_cast<float>(ForceScale::kLeast),
                                    static_cast<float>(ForceScale::kMost), "x %.2f",
                                    ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    moved = ImGui::SliderFloat("damping", &damping, 0.0F, static_cast<float>(ForceScale::kMostDamping_Ns_per_m),
                               "+ %.1f N s/m", ImGuiSliderFlags_AlwaysClamp) ||
            moved;
    ImGui::PopItemWidth();
    tip("Changes only the rendered force. Curves and figures show the unchanged models. J ends it.");
    const float below_px = top_px + ImGui::GetWindowHeight();
    ImGui::End();
    if (moved) session.controls().scale = {static_cast<double>(stiffness), static_cast<double>(damping)};
    return below_px;
  }

  // Draws the title of the scene, and any exaggeration of force or picture.
  void draw_title() const {
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
                         view.scales_force ? scale_words(session.controls().scale).c_str() : "arrows: difference x 10");
    }
    ImGui::End();
  }

  // Draws the verdict below the title. Returns the y of its lower edge.
  float draw_headline() const {
    const Verdict& verdict = models().verdict;
    const float head = height_of(fonts().heading), top = area.at.y + 2.0F * line();
    if (verdict.headline.empty()) return top;
    const float indent = verdict.chosen ? 1.1F * head : 0.0F;
    const ImVec2 at(area.at.x + 0.7F * line() + indent, top);
    const float room = area.size.x - indent - 1.4F * line();
    if (verdict.chosen) {
      draw_mark(list(), {at.x - 0.6F * head, top + 0.55F * head}, 0.36F * head, models().slots[*verdict.chosen].paper,
                ink(slot_colour(models(), *verdict.chosen, style.theme())), style);
    }
    // No line ends between a number and its unit.
    std::string headline = verdict.headline;
    for (std::size_t i = 0; (i = headline.find(" %", i)) != std::string::npos;) headline.replace(i, 1, "\u00A0");
    float y = draw_wrapped(fonts().heading, at, headline, text_ink(!verdict.chosen), room);
    if (!verdict.detail.empty())
      y = draw_wrapped(fonts().body, {at.x, y + 0.1F * line()}, verdict.detail, text_ink(true), room);
    return y + 0.3F * line();
  }

  // Returns the y below it.
  float draw_data_warning(float top_px) const {
    const std::string text = data_warning(models());
    if (text.empty()) return top_px;
    const float wrap = 0.8F * area.size.x, pad = 0.4F * line();
    const ImVec2 size = text_size(fonts().body, text, wrap);
    const ImVec2 at(area.at.x + 0.5F * (area.size.x - size.x), top_px + pad);
    draw_plate(list(), at, size, {2.0F * pad, pad}, ink(colours().raised), ink(colours().raised));
    text_at(fonts().body, at, text_ink(false), text, wrap);
    return at.y + size.y + 2.0F * pad;
  }

  // Draws the hint how to press, until the user has pressed with half a newton. Returns the y below it.
  float draw_hint(float top_px) const {
    constexpr double kPressed_N = 0.5;
    if (session.tool_input() == nullptr) return top_px;
    const bool alone = session.tool_input()->hand_is_exploring();
    if (!alone && session.newest().rendered_N > kPressed_N) view.has_pressed = true;
    if (!alone && view.has_pressed) return top_px;
    const std::string hint = alone ? "The hand moves by itself. Move the mouse down over the block to press it."
                                   : "Move the mouse down over the block to press it. No button is needed.";
    return draw_wrapped(fonts().body, {area.at.x + 0.9F * line(), top_px}, hint, text_ink(true),
                        area.size.x - 1.8F * line());
  }

  // Position in the area of a point relative to the middle of the top of block `index`.
  glm::vec2 on_screen(std::size_t index, const glm::vec3& point) const {
    return blocks.on_screen(index, shown.blocks.size(), point, {area.size.x, area.size.y});
  }

  // Top left corner of the label of block `index`. It is at the foot of the block, above the tool of a block in the
  // rear row, and in the upper right corner of the picture for a single block.
  ImVec2 label_place(std::size_t index, const ImVec2& size, float lift) const {
    const std::size_t count = shown.blocks.size();
    if (count == 1) return {area.at.x + area.size.x - 1.15F * size.x - size.y, area.at.y + 2.6F * size.y};
    if (count > 2 && index < 2) {  // in the rear row
      // The length of the tool with a margin, because the tool is lifted between presses.
      const auto above = 16.0F * static_cast<float>(blocks.geometry().tool_radius_m);
      const glm::vec2 top = on_screen(index, {0.0F, above, 0.0F});
      // The two labels of the row share the width if it is small.
      const glm::vec2 other = on_screen(1 - index, {0.0F, above, 0.0F});
      const float middle = 0.5F * (top.x + other.x), gap = 0.5F * size.y;
      const float low = top.x > other.x ? middle + gap : 4.0F;
      const float high = (top.x > other.x ? area.size.x - 4.0F : middle - gap) - size.x;
      const float x = std::clamp(top.x - 0.5F * size.x, std::min(low, high), std::max(low, high));
      return {area.at.x + x, area.at.y + std::max(3.0F * size.y, top.y - 1.9F * size.y)};
    }
    const auto half = 0.5F * static_cast<float>(blocks.geometry().length_m);
    const auto height = static_cast<float>(blocks.geometry().height_m);
    const glm::vec2 front = on_screen(index, {0.35F * half, -1.02F * height, half});  // before the block, on the table
    const float x = std::clamp(front.x - 0.5F * size.x, 4.0F, area.size.x - size.x - 4.0F);
    const float y = std::clamp(front.y + 0.25F * size.y, 4.0F, area.size.y - lift - 1.2F * size.y);
    return {area.at.x + x, area.at.y + y};
  }

  // Draws the names of the blocks.
  void draw_labels(float lift) const {
    const std::vector<std::size_t>& slots = shown.blocks;
    const float pad = 0.25F * height_of(fonts().heading);
    for (std::size_t i = 0; i < slots.size(); ++i) {
      const bool reference = slots[i] == kReferenceBlock;
      const std::string text =
          reference ? shown.reference_block
                    : std::to_string(models().number_of(slots[i])) + "  " + models().slots[slots[i]].name;
      const ImVec2 size = text_size(fonts().heading, text), at = label_place(i, size, lift);
      const bool active = slots[i] == models().selected, best = models().verdict.chosen == slots[i];
      const ImU32 colour =
          ink(reference ? reference_colour(style.theme()) : slot_colour(models(), slots[i], style.theme()));
      draw_plate(list(), at, size, {2.0F * pad, 0.5F * pad}, ink(colours().panel, 0.88F), colour);
      if (slots.size() > 1 && active) {
        list().AddRect({at.x - 2.0F * pad, at.y - 0.5F * pad}, {at.x + size.x + 2.0F * pad, at.y + size.y + 0.5F * pad},
                       colour, 6.0F, 0, 2.0F);
      }
      text_at(fonts().heading, at, text_ink(!active && !best), text);
      if (!active && !best) continue;
      const std::string mark = best && active ? "best, and active" : best ? "best" : slots.size() > 1 ? "active" : "";
      text_at(fonts().body, {at.x + 0.5F * (size.x - text_size(fonts().body, mark).x), at.y + size.y + 0.6F * pad},
              text_ink(false), mark);
    }
  }

  float big_number_height(float lift) const { return lift + height_of(fonts().big) + 1.9F * line(); }

  // Draws the error of the model in the headline as a large number with its description, and the colour scale of
  // errors.
  void draw_big_number(float lift) const {
    const ImVec2 corner(area.at.x + 1.1F * line(), area.at.y + area.size.y - lift);
    const BigNumber big = big_number(models());
    const Rgb colour = big.error_over_jnd > 1.0 ? text_colour(kAboveJndColour, style.theme()) : colours().text;
    const float y = area.at.y + area.size.y - big_number_height(lift);
    text_at(fonts().big, {corner.x, y}, ink(colour), big.number);
    if (ImGui::IsMouseHoveringRect({corner.x, y}, {area.at.x + area.size.x, corner.y})) {
      ImGui::SetTooltip(
          "99 %% of the samples in contact are off by at most this, in just noticeable differences (JND), over %s.\n"
          "Your press: the same of what was pressed here since the last reset (C), with the active model.",
          models().counted.c_str());
    }
    const ImVec2 usual = text_size(fonts().big, "0.00");
    const ImVec2 beside(corner.x + std::max(usual.x, text_size(fonts().big, big.number).x) + 0.7F * line(),
                        y + 0.30F * usual.y);
    text_at(fonts().body, beside, text_ink(false), big.what);
    text_at(fonts().body, {beside.x, beside.y + 1.15F * line()}, text_ink(true), big.below);
    const float width = 11.0F * line(), top = y + usual.y + 0.35F * line(), bottom = top + 0.55F * line();
    for (int i = 0; i < 40; ++i) {
      const float from = static_cast<float>(i) / 40.0F;
      list().AddRectFilled({corner.x + from * width, top}, {corner.x + (from + 0.025F) * width + 0.5F, bottom},
                           ink(error_colour(static_cast<double>(from))));
    }
    list().AddRect({corner.x, top}, {corner.x + width, bottom}, ink(colours().edge));
    list().AddRectFilled({corner.x + width + 3.0F, top}, {corner.x + 1.3F * width, bottom}, ink(kAboveJndColour));
    const auto label = [&](float right, const char* text) {
      text_at(fonts().body, {corner.x + right, bottom + 1.0F}, text_ink(true), text);
    };
    label(0.0F, "0");
    label(width - 0.3F * line(), "1");
    label(width + line(), "error / JND");
  }

  // Draws five buttons, and a menu of all other commands.
  void draw_buttons() const {
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

  void draw_replay_bar(float lift) const {
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
    if (ImGui::SliderFloat("##at", &at_s, 0.0F, static_cast<float>(replay.duration_s()), ""))
      replay.seek(static_cast<double>(at_s));
    tip("Position in the recording");
    ImGui::SameLine();
    ImGui::Text("%5.1f of %.1f s", replay.playhead_s(), replay.duration_s());
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-4.5F * ImGui::GetFontSize());
    auto speed = static_cast<float>(replay.speed());
    if (ImGui::SliderFloat("##speed", &speed, 0.05F, 10.0F, "", ImGuiSliderFlags_Logarithmic))
      replay.set_speed(static_cast<double>(speed));
    tip("Speed of the replay");
    ImGui::SameLine();
    ImGui::Text("%.2f x", replay.speed());
    if (session.test().found_m() != 0.0) {
      bool moved = session.test().moved();
      const std::string label =
          "surface " + fixed(1e3 * session.test().found_m(), 2) + " mm from that of the models; move it there";
      if (ImGui::Checkbox(label.c_str(), &moved)) session.move_surface(moved);
      tip("On: the surface is moved to where the models fit the recording best. Off: the positions are as recorded.");
    }
    ImGui::End();
  }

  // Draws the state of a recording that is being made.
  void draw_recording() const {
    const std::string text = recording_words(session.recording());
    if (text.empty()) return;
    const ImVec2 size = text_size(fonts().body, text);
    const ImVec2 at(area.at.x + area.size.x - size.x - size.y, area.at.y + 0.9F * size.y);
    list().AddCircleFilled({at.x - 0.7F * size.y, at.y + 0.55F * size.y}, 0.35F * size.y, text_ink(false));
    text_at(fonts().body, at, text_ink(false), text);
  }

  // Draws the instructions for a scene without models and material, or the request of the device to its user, in large
  // text in the middle.
  void draw_request() const {
    std::string words = session.device_words();
    if (session.models().size() == 0 && session.replay() == nullptr) {
      words = "No model yet, and no virtual material stands in for \"" + session.scene().title +
              "\".\nDrop a recording (CSV) here to fit it or to replay it, or a model file (M lists them).\n"
              "O chooses a scene with a material.";
    }
    if (words.empty()) return;
    words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
    ImGui::SetNextWindowPos({area.at.x + 0.5F * area.size.x, area.at.y + 0.32F * area.size.y}, ImGuiCond_Always,
                            {0.5F, 0.5F});
    ImGui::SetNextWindowSize({0.8F * area.size.x, 0.0F});
    ImGui::Begin("device", nullptr, kFloating & ~ImGuiWindowFlags_NoBackground);
    ImGui::PushFont(fonts().heading);
    ImGui::TextWrapped("%s", words.c_str());
    ImGui::PopFont();
    if (session.newest().device.zeroing == Zeroing::needed && ImGui::Button("Zero here (Z)")) session.start_zeroing();
    ImGui::End();
  }

  // Draws notices from `y` downwards.
  void draw_toasts(float y) const {
    const float pad = 0.6F * line(), wrap = 0.86F * area.size.x;
    ImDrawList& front = *ImGui::GetForegroundDrawList();
    for (const Toast& toast : view.toasts) {
      const ImVec2 size = text_size(fonts().body, toast.text, wrap);
      const float x = area.at.x + 0.5F * (area.size.x - size.x);
      draw_plate(front, {x, y}, size, {pad, pad}, ink(colours().raised),
                 ink(toast.problem ? colours().fault : reference_colour(style.theme())));
      front.AddText(fonts().body, line(), {x, y}, text_ink(false), toast.text.c_str(), nullptr, wrap);
      y += size.y + 2.6F * pad;
    }
  }

  void draw() const {
    const bool exhibit = view.exhibit.on;  // has its own texts
    const float buttons =
        exhibit ? 0.0F : std::max(ImGui::GetFrameHeight() + 2.0F * ImGui::GetStyle().WindowPadding.y, 2.4F * line());
    const float surface = session.test().found_m() != 0.0 ? 1.7F * line() : 0.0F;
    const float bars = buttons + (session.replay() != nullptr ? 2.4F * line() + surface : 0.0F);
    float top_px = area.at.y + 2.0F * line();
    if (!exhibit) {
      draw_labels(big_number_height(bars));
      if (!models().slots.empty()) draw_big_number(bars);
      draw_title();
      top_px = draw_headline();
      top_px = draw_data_warning(top_px);
      if (view.scales_force) {
        top_px = draw_feel(top_px);
      } else if (data_warning(models()).empty()) {
        top_px = draw_hint(top_px);
      }
    }
    draw_recording();
    if (session.replay() != nullptr) draw_replay_bar(buttons);
    if (!exhibit) draw_buttons();
    if (!view.dialogs.recording_roles.any()) draw_request();
    draw_toasts(top_px + 0.5F * line());
  }
};

}  // namespace

std::string scale_words(const ForceScale& scale) {
  return "in the hand: stiffness x " + fixed(scale.stiffness, 2) + ", damping + " + fixed(scale.damping_Ns_per_m, 1);
}

std::string recording_words(const RecordingStatus& recording) {
  if (!recording.active && !recording.saving) return {};
  const std::string name = std::filesystem::path(recording.path).filename().string();
  if (recording.saving) return "saving " + name;
  return "recording " + name + ": " + fixed(recording.seconds, 1) + " s, " + std::to_string(recording.rows) +
         " samples";
}

void draw_overlay(LiveSession& session, const WindowView& shown, const BlockView& blocks, ViewState& view,
                  const UiStyle& style, const SceneArea& area, const OverlayActions& actions) {
  Overlay{session, shown, blocks, view, style, area, *actions.commands}.draw();
  draw_dialogs(session, view, style, actions);
}

}  // namespace palpate
