#include "rendering/panels/panel.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

#include "engine/base/text.h"

namespace palpate {
namespace {

constexpr auto kFloating = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                           ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_AlwaysAutoResize |
                           ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

// The sides of a button for a finger, 44 pixels of a display of usual density.
float button_px(const UiStyle& style) { return 44.0F * std::max(style.scale() / kSmallestScale, 1.0F); }
// Height of the buttons, and of the bar of a replay above them.
float buttons_height(const UiStyle& style) {
  return std::max(button_px(style), 2.4F * height_of(style.fonts().body)) + 2.0F * ImGui::GetStyle().WindowPadding.y;
}
float replay_height(const WindowView& shown, const UiStyle& style) {
  if (shown.replay == nullptr) return 0.0F;
  return button_px(style) + (shown.surface_m != 0.0 ? 2.7F : 1.0F) * height_of(style.fonts().body);
}
// Whether notes have room beside the big number; else they are below the headline.
bool has_corner(const UiStyle& style, const SceneArea& area) {
  return area.size.x > 40.0F * height_of(style.fonts().body);
}
// Height of the two sliders below the headline that scale the rendered force.
float feel_height(const UiStyle& style) { return 3.9F * height_of(style.fonts().body); }
float big_number_height(const UiStyle& style, float lift) {
  return lift + height_of(style.fonts().big) + 1.9F * height_of(style.fonts().body);
}

// The verdict below the title, and where its lines end.
struct Headline {
  std::string words;
  ImVec2 at;
  float room;  // the width to which its detail is wrapped
  float detail_px, below_px;
};
Headline headline_of(const Verdict& verdict, const UiStyle& style, const SceneArea& area) {
  const Fonts& fonts = style.fonts();
  const float line = height_of(fonts.body), top = area.at.y + 2.0F * line;
  if (verdict.headline.empty()) return {{}, {}, 0.0F, top, top};
  const float indent = verdict.chosen ? 1.1F * height_of(fonts.heading) : 0.0F;
  const float room = area.size.x - indent - 1.4F * line;
  Headline headline{{}, {area.at.x + 0.7F * line + indent, top}, room, top, top};
  // No line ends between a number and its unit.
  const std::string& words = headline.words =
      in_lines(replaced(replaced(verdict.headline, " %", "\u00A0%"), " us", "\u00A0us"), room, fonts.heading);
  headline.detail_px = headline.below_px = top + text_size(fonts.heading, words).y;
  if (!verdict.detail.empty()) {
    headline.detail_px += 0.1F * line;
    headline.below_px = headline.detail_px + text_size(fonts.body, verdict.detail, headline.room).y;
  }
  headline.below_px += 0.3F * line;
  return headline;
}

// The overlay of a frame. `lift` in its functions: height of other parts at the lower edge of the area.
struct Overlay {
  const WindowView& shown;
  const BlockView& blocks;
  ViewState& view;
  const UiStyle& style;
  const SceneArea& area;
  const WindowActions& actions;
  const std::vector<WindowCommand>& commands = *actions.commands;

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

  // Draws the sliders that scale the rendered force.
  void draw_feel(float top_px) const {
    ImGui::SetNextWindowPos({area.at.x + 2.0F, top_px});
    ImGui::Begin("over feel", nullptr, kFloating);
    auto stiffness = static_cast<float>(shown.scale.stiffness);
    auto damping = static_cast<float>(shown.scale.damping_Ns_per_m);
    ImGui::PushItemWidth(0.28F * area.size.x);
    // The numbers are beside the sliders, because the grip would hide them.
    ImGui::PushStyleColor(ImGuiCol_Text, paint(text_colour(kAboveJndColour, style.theme())));
    bool moved =
        ImGui::SliderFloat(("in the hand: stiffness x " + fixed(shown.scale.stiffness, 2) + "###stiffness").c_str(),
                           &stiffness, static_cast<float>(ForceScale::kLeast), static_cast<float>(ForceScale::kMost),
                           "", ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    moved = ImGui::SliderFloat(("damping + " + fixed(shown.scale.damping_Ns_per_m, 1) + " N s/m###damping").c_str(),
                               &damping, 0.0F, static_cast<float>(ForceScale::kMostDamping_Ns_per_m), "",
                               ImGuiSliderFlags_AlwaysClamp) ||
            moved;
    ImGui::PopStyleColor();
    ImGui::PopItemWidth();
    tip("Changes only the rendered force. Curves and figures show the unchanged models. F ends it.");
    ImGui::End();
    if (moved) actions.scale({stiffness, damping});
  }

  void draw_title() const {
    ImGui::SetNextWindowPos({area.at.x + 2.0F, area.at.y + 2.0F});
    ImGui::Begin("over title", nullptr, kFloating);
    ImGui::TextUnformatted(shown.scene->title.c_str());
    tip(shown.scene->description.c_str());
    ImGui::SameLine(0.0F, ImGui::GetFontSize());
    const ImVec4 warning = paint(text_colour(kAboveJndColour, style.theme()));
    if (view.worst) {
      const std::string& name = models().slots[view.worst->slot].name;
      ImGui::TextColored(warning, "largest error of %s in %s: %s (Space goes on)", name.c_str(),
                         view.worst->history ? "the test" : "this session", view.worst->words.c_str());
    } else {
      ImGui::TextDisabled("drawn twice as deep");
    }
    if (view.exaggerated) {
      ImGui::SameLine(0.0F, ImGui::GetFontSize());
      ImGui::TextColored(warning, "arrows: difference x 10");
    }
    ImGui::End();
  }

  // Draws the verdict below the title. Returns the y of its lower edge.
  float draw_headline() const {
    const Verdict& verdict = models().verdict;
    const Headline headline = headline_of(verdict, style, area);
    if (verdict.headline.empty()) return headline.below_px;
    const float head = height_of(fonts().heading);
    if (verdict.chosen) {
      draw_mark(list(), {headline.at.x - 0.6F * head, headline.at.y + 0.55F * head}, 0.36F * head,
                models().slots[*verdict.chosen].paper, ink(slot_colour(models(), *verdict.chosen, style.theme())),
                style);
    }
    text_at(fonts().heading, headline.at, text_ink(!verdict.chosen), headline.words);
    text_at(fonts().body, {headline.at.x, headline.detail_px}, text_ink(true), verdict.detail, headline.room);
    return headline.below_px;
  }

  // The error and the time of a model, as in the table.
  std::string figures_of(const ModelView& model) const {
    if (model.refitting) return "–";
    std::string text;
    if (model.is_judged()) text = jnd_text(model.errors.p99_error_over_jnd) + " JND";
    if (model.tick_ns() > 0.0) text += (text.empty() ? "" : ", ") + fixed(model.tick_ns(), 0) + " ns";
    return text;
  }

  // The number of a block, with which its key chooses it.
  std::string number_of(std::size_t slot) const {
    return std::to_string(slot == kReferenceBlock ? models().listed().size() + 1 : models().number_of(slot)) + "  ";
  }

  // Draws name, 99 % error and time of each model below its block. Returns the y of the lowest edge.
  float draw_labels() const {
    float lowest_px = area.at.y;
    const std::vector<std::size_t>& slots = shown.blocks;
    const glm::vec2 picture(area.size.x, area.size.y);
    const float pad = 0.22F * line();
    for (std::size_t i = 0; i < slots.size(); ++i) {
      const bool reference = slots[i] == kReferenceBlock;
      const ModelView* model = reference ? nullptr : &models().slots[slots[i]];
      const glm::vec2 foot = blocks.foot(i, slots.size(), picture);
      const float room = std::min(blocks.width_of_one(slots.size(), picture), area.size.x) - 6.0F * pad;
      std::string name = number_of(slots[i]) + (reference ? shown.reference_block : model->name);
      std::string figures = reference ? "what all are compared with" : figures_of(*model);
      // Too little room: smaller, then shorter.
      ImFont* font = text_size(fonts().heading, name).x < room ? fonts().heading : fonts().body;
      if (text_size(font, name).x > room) name.erase(std::min(name.find('-'), name.size()));
      if (text_size(font, name).x > room) name = number_of(slots[i]) + (reference ? "truth" : "");
      if (text_size(fonts().body, figures).x > room) figures = figures.substr(0, figures.find(", "));
      if (text_size(fonts().body, figures).x > room) figures.clear();
      const ImVec2 above = text_size(font, name), below = text_size(fonts().body, figures);
      const ImVec2 size(std::max(above.x, below.x), above.y + (figures.empty() ? 0.0F : below.y));
      const float right = std::max(3.0F * pad, area.size.x - size.x - 3.0F * pad);
      const ImVec2 at(area.at.x + std::clamp(foot.x - 0.5F * size.x, 3.0F * pad, right),
                      area.at.y + foot.y + 2.5F * pad);
      const Rgb colour = reference ? reference_colour(style.theme()) : slot_colour(models(), slots[i], style.theme());
      const bool active =
          (reference ? view.material : !view.material && slots[i] == models().selected) && slots.size() > 1;
      draw_plate(list(), at, size, {2.5F * pad, pad}, ink(colours().panel, 0.9F), ink(colour));
      if (active) {
        list().AddRect({at.x - 2.5F * pad, at.y - pad}, {at.x + size.x + 2.5F * pad, at.y + size.y + pad}, ink(colour),
                       6.0F, 0, 2.0F);
      }
      lowest_px = std::max(lowest_px, at.y + size.y + pad);
      text_at(font, at, text_ink(false), name);
      const bool above_jnd = !reference && model->is_judged() && model->errors.p99_error_over_jnd > 1.0;
      const ImU32 shade = above_jnd ? ink(text_colour(kAboveJndColour, style.theme())) : text_ink(true);
      text_at(fonts().body, {at.x, at.y + above.y}, shade, figures);
    }
    return lowest_px;
  }

  ImU32 error_ink(double over_jnd, bool quiet) const {
    return over_jnd > 1.0 ? ink(text_colour(kAboveJndColour, style.theme())) : text_ink(quiet);
  }

  // Draws the error of the active model as a large number with its description, and the colour scale of errors.
  // Returns the x at the right of its texts.
  float draw_big_number(float lift) const {
    const ImVec2 corner(area.at.x + 1.1F * line(), area.at.y + area.size.y - lift);
    const BigNumber big = big_number(models());
    const float y = area.at.y + area.size.y - big_number_height(style, lift);
    text_at(fonts().big, {corner.x, y}, error_ink(big.error_over_jnd, false), big.number);
    if (ImGui::IsMouseHoveringRect({corner.x, y}, {area.at.x + 0.5F * area.size.x, corner.y})) {
      ImGui::SetTooltip(
          "Of the samples in contact, 99 %% are off by at most this, in just noticeable differences (JND), over %s.\n"
          "This press: the largest mean over 50 ms since the tool touched the block. W shows the largest error.",
          models().counted.c_str());
    }
    const ImVec2 usual = text_size(fonts().big, "0.00");
    const ImVec2 beside(corner.x + std::max(usual.x, text_size(fonts().big, big.number).x) + 0.7F * line(),
                        y + 0.30F * usual.y);
    const float room = area.at.x + area.size.x - beside.x - 0.5F * line();
    const std::string what = fitting(big.what, room);
    text_at(fonts().body, beside, text_ink(false), what);
    text_at(fonts().body, {beside.x, beside.y + 1.15F * line()}, error_ink(big.press_over_jnd, true), big.below);
    const float width = 11.0F * line(), top = y + usual.y + 0.35F * line(), bottom = top + 0.55F * line();
    for (int i = 0; i < 40; ++i) {
      const float from = static_cast<float>(i) / 40.0F;
      list().AddRectFilled({corner.x + from * width, top}, {corner.x + (from + 0.025F) * width + 0.5F, bottom},
                           ink(error_colour(from)));
    }
    list().AddRect({corner.x, top}, {corner.x + width, bottom}, ink(colours().edge));
    list().AddRectFilled({corner.x + width + 3.0F, top}, {corner.x + 1.3F * width, bottom}, ink(kAboveJndColour));
    const auto label = [&](float right, const char* text) {
      text_at(fonts().body, {corner.x + right, bottom + 1.0F}, text_ink(true), text);
    };
    label(0.0F, "0");
    label(width - 0.3F * line(), "1");
    label(width + line(), "error / JND");
    return beside.x + std::max(text_size(fonts().body, what).x, 15.0F * line());
  }

  void draw_buttons() const {
    ImGui::SetNextWindowPos({area.at.x + 2.0F, area.at.y + area.size.y - 2.0F}, ImGuiCond_Always, {0.0F, 1.0F});
    ImGui::Begin("over buttons", nullptr, kFloating);
    const float side = button_px(style);
    int place = 0;
    const auto show_focus = [&] {
      if (place++ != view.focus) return;
      ImGui::GetWindowDrawList()->AddRect(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), text_ink(false), 4.0F, 0,
                                          3.0F);
    };
    for (const WindowCommand& command : commands) {
      if (!command.bar) continue;
      if (command_button(command, side)) command.run(0);
      show_focus();
      ImGui::SameLine(0.0F, 4.0F);
    }
    const bool menu = std::exchange(view.opens_menu, false);
    if (ImGui::Button("Menu", {0.0F, side}) || menu) ImGui::OpenPopup("menu");
    show_focus();
    tip("All other commands and their keys (M)");
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
    ReplayControl& replay = *shown.replay;
    ImGui::SetNextWindowPos({area.at.x + 2.0F, area.at.y + area.size.y - lift}, ImGuiCond_Always, {0.0F, 1.0F});
    ImGui::SetNextWindowSize({area.size.x - 4.0F, 0.0F});
    ImGui::Begin("over replay", nullptr, kFloating & ~ImGuiWindowFlags_AlwaysAutoResize);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        {ImGui::GetStyle().FramePadding.x, 0.5F * (button_px(style) - ImGui::GetFontSize())});
    for (const WindowCommand& command : commands) {
      if (command.label.empty() || !command.replay) continue;
      if (command_button(command)) command.run(0);
      ImGui::SameLine();
    }
    // The numbers are beside the sliders, because the grip would hide them.
    ImGui::SetNextItemWidth(0.40F * area.size.x);
    auto at_s = static_cast<float>(replay.playhead_s());
    if (ImGui::SliderFloat("##at", &at_s, 0.0F, static_cast<float>(replay.duration_s()), "")) replay.seek(at_s);
    tip("Position in the recording");
    ImGui::SameLine();
    ImGui::Text("%5.1f of %.1f s", replay.playhead_s(), replay.duration_s());
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-4.5F * ImGui::GetFontSize());
    auto speed = static_cast<float>(replay.speed());
    if (ImGui::SliderFloat("##speed", &speed, 0.05F, 10.0F, "", ImGuiSliderFlags_Logarithmic)) replay.set_speed(speed);
    tip("Speed of the replay");
    ImGui::SameLine();
    ImGui::Text("%.2f x", replay.speed());
    ImGui::PopStyleVar();
    if (shown.surface_m != 0.0) {
      bool moved = shown.surface_moved;
      const std::string label =
          "surface " + fixed(1e3 * shown.surface_m, 2) + " mm from that of the models; move it there";
      if (ImGui::Checkbox(label.c_str(), &moved)) actions.move_surface(moved);
      tip("On: the surface is moved to where the models fit the recording best. Off: the positions are as recorded.");
    }
    ImGui::End();
  }

  // Draws the instructions for a scene without models and material, or the request of the device to its user, in large
  // text in the middle.
  void draw_request() const {
    std::string words = shown.device_words;
    if (models().slots.empty() && shown.replay == nullptr) {
      words = "No model yet, and no virtual material stands in for \"" + shown.scene->title +
              "\".\nDrop a recording (CSV) here to fit it or to replay it, or a model file (O lists them).\n"
              "S chooses a scene with a material.";
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
    if (shown.health.newest.device.zeroing == Zeroing::needed && ImGui::Button("Zero here (Z)")) actions.zero_device();
    ImGui::End();
  }

  // Draws what has to be said now on plates in the corner at the right of `left_px`, from `bottom_px` up to
  // `labels_px`, which no block covers; what has no room there, below `top_px`.
  void draw_notes(float left_px, float bottom_px, float labels_px, float top_px) const {
    const bool exhibit = view.exhibit.on;
    std::vector<std::pair<std::string, ImU32>> notes;
    for (const Toast& toast : view.toasts)
      notes.emplace_back(toast.text, ink(toast.problem ? colours().fault : colours().text));
    const std::string warning = exhibit ? "" : data_warning(models());
    if (!warning.empty()) notes.emplace_back(warning, ink(colours().fault));
    if (const std::string hint = exhibit ? "" : press_hint(shown, view); !hint.empty() && notes.empty())
      notes.emplace_back(hint, ink(colours().quiet));
    if (const std::string recording = recording_words(shown.recording); !recording.empty())
      notes.insert(notes.begin(), {recording, ink(colours().text)});
    const float pad = 0.5F * line();
    bool corner = true;
    float wrap = area.at.x + area.size.x - left_px - 3.0F * pad, y = bottom_px;
    for (const auto& [text, stripe] : notes) {
      ImVec2 size = text_size(fonts().body, text, wrap);
      if (corner && (!has_corner(style, area) || y - size.y - 2.0F * pad < labels_px)) {
        corner = false, y = top_px, wrap = 0.86F * area.size.x;
        size = text_size(fonts().body, text, wrap);
      }
      if (corner) y -= size.y + 2.0F * pad;
      const float x =
          corner ? area.at.x + area.size.x - size.x - 2.0F * pad : area.at.x + 0.5F * (area.size.x - size.x);
      ImDrawList& where =
          corner || view.dialogs.any() ? list() : *ImGui::GetForegroundDrawList();  // in front of what moves
      draw_plate(where, {x, y + pad}, size, {pad, 0.5F * pad}, ink(colours().raised), stripe);
      where.AddText(fonts().body, line(), {x, y + pad}, text_ink(false), text.c_str(), nullptr, wrap);
      if (!corner) y += size.y + 2.0F * pad;
    }
  }

  void draw() const {
    const bool exhibit = view.exhibit.on;  // has its own texts
    const float buttons = exhibit ? 0.0F : buttons_height(style);
    const float bars = buttons + replay_height(shown, style);
    float top_px = area.at.y + 2.0F * line(), left_px = area.at.x, labels_px = area.at.y;
    if (!exhibit) {
      labels_px = draw_labels();
      left_px = draw_big_number(bars);
      draw_title();
      top_px = draw_headline();
      if (view.scales_force) draw_feel(std::exchange(top_px, top_px + feel_height(style)));
    }
    if (shown.replay != nullptr) draw_replay_bar(buttons);
    if (!exhibit) draw_buttons();
    if (!view.dialogs.recording_roles.any()) draw_request();
    draw_notes(left_px, area.at.y + area.size.y - bars, labels_px, top_px);
  }
};

}  // namespace

std::string press_hint(const WindowView& shown, ViewState& view) {
  constexpr double kPressed_N = 0.5;
  if (shown.tool == nullptr || (shown.models.slots.empty() && !shown.scene->has_material())) return {};
  if (shown.hand_explores) return "The hand moves by itself. Press the mouse button on a block and pull down.";
  if (shown.health.newest.rendered_N > kPressed_N) view.has_pressed = true;
  return view.has_pressed ? "" : "Press the mouse button on a block and pull down; let go to lift the probe.";
}

SceneArea stage_of(const WindowView& shown, const ViewState& view, const UiStyle& style, const SceneArea& area) {
  if (view.exhibit.on) return area;
  // At least room for a title, a headline of two lines, and its detail, so that the blocks seldom move.
  const float usual = 3.4F * height_of(style.fonts().body) + 2.0F * height_of(style.fonts().heading);
  const float sliders = view.scales_force ? feel_height(style) : 0.0F;
  const float notes = has_corner(style, area) ? 0.0F : 3.2F * height_of(style.fonts().body);
  const float above =
      std::max(usual, headline_of(shown.models.verdict, style, area).below_px - area.at.y) + sliders + notes;
  const float below = big_number_height(style, buttons_height(style) + replay_height(shown, style));
  return {{area.at.x, area.at.y + above}, {area.size.x, std::max(1.0F, area.size.y - above - below)}};
}

std::string recording_words(const RecordingStatus& recording) {
  if (!recording.active && !recording.saving) return {};
  const std::string name = std::filesystem::path(recording.path).filename().string();
  if (recording.saving) return "saving " + name;
  return "recording " + name + ": " + fixed(recording.seconds, 1) + " s, " + std::to_string(recording.rows) +
         " samples";
}

void draw_overlay(const WindowView& shown, const BlockView& blocks, ViewState& view, const UiStyle& style,
                  const SceneArea& area, const WindowActions& actions) {
  Overlay{shown, blocks, view, style, area, actions}.draw();
  draw_dialogs(shown, view, actions);
}

}  // namespace palpate
