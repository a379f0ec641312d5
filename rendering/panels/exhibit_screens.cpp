// Draws the screens of the exhibit.
#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "rendering/panels/exhibit.h"

namespace palpate {
namespace {

using State = ExhibitGame::State;

constexpr double kLeastRange_jnd = 4.0;  // of the axis, so that rounds are comparable

bool pointer_moved() {
  const ImGuiIO& io = ImGui::GetIO();
  return io.MouseDelta.x != 0.0F || io.MouseDelta.y != 0.0F || io.MouseWheel != 0.0F || ImGui::IsAnyMouseDown();
}

}  // namespace

struct Exhibit::Screens {
  Exhibit& exhibit;
  ExhibitGame& game;
  const WindowView& shown;
  const BlockView& blocks;
  const UiStyle& style;
  const WindowLayout& layout;

  const ExhibitWords& words() const { return exhibit.words(); }
  // The end of the panel above the foot.
  float bottom() const { return layout.panel.at.y + layout.panel.size.y - 2.6F * body(); }
  float body() const { return height_of(style.fonts().body); }
  double now_s() const { return shown.health.newest.loop_time_s; }
  // Whether the panel has no room for headings, as at 800x600.
  bool low() const { return layout.panel.size.y < 20.0F * height_of(style.fonts().heading); }
  void space(float lines) const { ImGui::Dummy({1.0F, lines * (low() ? 0.5F : 1.0F) * body()}); }
  static std::string centres_of(const ExhibitModel& model) { return std::to_string(model.centres); }
  // The ending of the keys of the texts about a model. A trend without a correction has no centres.
  static std::string kind_of(const ExhibitModel& model) {
    return model.paper ? "paper" : model.centres > 0 ? "best" : "trend";
  }
  Rgb colour_of(const ExhibitModel& model) const { return slot_colour(shown.models, model.slot, style.theme()); }

  std::string localised(const std::string& text) const { return replaced(text, ".", words()("decimal")); }
  // The number with the digits that a reader needs.
  std::string number(double value) const {
    return value <= 0.0 ? "0" : localised(fixed(std::max(0.01, value), value < 1.0 ? 2 : 1));
  }
  std::string newtons(double force_N) const { return localised(fixed(force_N, force_N < 0.95 ? 2 : 1)) + " N"; }

  void say(const std::string& text) {
    ImGui::TextUnformatted(in_lines(text, ImGui::GetContentRegionAvail().x).c_str());
    exhibit.said_.push_back(text);
  }
  // As large as there is room for.
  void say_long(const std::string& text) {
    say_in(low() ? style.fonts().body : style.fonts().heading, style.colours().text, text);
  }
  void say_in(ImFont* font, const Rgb& colour, const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, paint(colour));
    ImGui::PushFont(font);
    say(text);
    ImGui::PopFont();
    ImGui::PopStyleColor();
  }
  void say_quietly(const std::string& text) { say_in(style.fonts().body, style.colours().quiet, text); }

  // Whether the button, which is high enough for a finger, or the key in its corner was pressed.
  bool button(const std::string& text, const std::string& key, ImVec2 size = {-1.0F, 0.0F}, bool down = false) {
    size.y = std::max(size.y, 2.2F * height_of(style.fonts().heading));
    if (down) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyle().Colors[ImGuiCol_ButtonActive]);
    const bool clicked = ImGui::Button(text.c_str(), size);
    if (down) ImGui::PopStyleColor();
    const ImVec2 low = ImGui::GetItemRectMin(), corner = ImGui::GetItemRectMax();
    ImFont* font = style.fonts().body;
    const float line = body();
    ImGui::GetWindowDrawList()->AddText(font, line,
                                        {corner.x - text_size(font, key).x - 0.4F * line, corner.y - 1.2F * line},
                                        ink(style.colours().quiet), key.c_str());
    exhibit.buttons_[key] = {0.5F * (low.x + corner.x), 0.5F * (low.y + corner.y)};
    return clicked || exhibit.pressed_ == key;
  }
  // Two buttons beside each other. Returns 1 or 2 where one was pressed, else 0.
  int pair_of_buttons(const char* left, const char* left_key, const char* right, const char* right_key, int down = 0) {
    const ImVec2 half(0.5F * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x), 0.0F);
    const bool one = button(words()(left), left_key, half, down == 1);
    ImGui::SameLine();
    const bool two = button(words()(right), right_key, half, down == 2);
    return one ? 1 : two ? 2 : 0;
  }

  // The difference of the right block from the left one, on an axis that shows all of it.
  void draw_difference(const ExhibitTrace& trace, double seconds) {
    say_quietly(words()("axis_difference"));
    const double largest = trace.largest_over_jnd();
    say_quietly(largest > 0.0 ? words()("so_far", number(largest)) : words()("in_band"));
    const double range = std::max(kLeastRange_jnd, round_up(1.05 * largest));
    ImGui::PushFont(style.fonts().body);  // of the axes
    const float height = bottom() - ImGui::GetCursorScreenPos().y;
    const LivePlot plot(style, {ImGui::GetContentRegionAvail().x, height},
                        {{0.0, seconds}, {-range, range}, "s", "", false, 0.0});
    ImGui::PopFont();
    plot.jnd_band(-1.0, 1.0);
    std::vector<ImVec2> points;
    const auto flush = [&] {
      plot.line(points, ink(style.colours().text), 4.0F * style.scale());
      points.clear();
    };
    for (std::size_t i = 0; i < trace.columns().size(); ++i) {
      const double over_jnd = trace.columns()[i].over_jnd;
      if (std::isnan(over_jnd)) {
        flush();
      } else {
        points.emplace_back(plot.x_px(static_cast<double>(i) * ExhibitTrace::kColumn_s),
                            plot.y_px(exhibit.computer_is_left() ? -over_jnd : over_jnd));
      }
    }
    flush();
  }

  // What a model remembers: dots on the curve of a press.
  void draw_moments(const ExhibitModel& model, const ImVec2& size) const {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const auto point = [&](float share) {
      const float rise = std::sin(3.1416F * std::pow(share, 0.7F));
      return ImVec2(at.x + share * size.x, at.y + (0.95F - 0.85F * rise * rise) * size.y);
    };
    std::vector<ImVec2> curve;
    for (int i = 0; i <= 60; ++i) curve.push_back(point(static_cast<float>(i) / 60.0F));
    list.AddPolyline(curve.data(), static_cast<int>(curve.size()), ink(style.colours().quiet), 0, 2.0F);
    const int dots = std::max(model.centres, 1);
    const float radius = dots > 50 ? 0.13F * body() : 0.22F * body();
    for (int i = 0; i < dots; ++i)
      list.AddCircleFilled(point((static_cast<float>(i) + 0.5F) / static_cast<float>(dots)), radius,
                           ink(style.colours().text));
    ImGui::Dummy(size);
  }

  void draw_attract() {
    say_long(words()("attract"));
    space(0.3F);
    say_quietly(words()("attract_more"));
    space(0.6F);
    if (!exhibit.knows_pair()) return draw_learning();
    if (button(words()("play"), "1")) return exhibit.begin(shown);
    space(0.6F);
    say_long(words()(exhibit.shows_worst() ? "attract_worst" : "attract_best"));
    draw_difference(exhibit.attract_trace(), exhibit.times_.press_s);
  }

  void draw_learning() {
    say_quietly(words()("learning"));
    float done = 0.0F;
    for (const ModelView& slot : shown.models.slots)
      done += slot.state == SlotState::ready ? 1.0F : static_cast<float>(slot.progress);
    const auto all = static_cast<float>(std::max<std::size_t>(shown.models.slots.size(), 1));
    ImGui::ProgressBar(done / all, {-1.0F, 0.8F * body()}, "");
  }

  void draw_press() {
    say_quietly(words()("round", std::to_string(game.level() + 1), std::to_string(game.rounds().size())));
    say_long(words()("hint_" + kind_of(game.computer()), centres_of(game.computer())));
    draw_moments(game.computer(), {ImGui::GetContentRegionAvail().x, 2.4F * body()});
    if (game.has_force()) {
      const int chosen = pair_of_buttons("left", "←", "right", "→", game.chosen_left() ? 1 : 2);
      if (chosen != 0) game.choose(chosen == 1);
    }
    say_long(words()(game.can_answer() ? game.has_force() ? "question_felt" : "question" : "press"));
    if (!game.can_answer()) {
      say_quietly(words()(game.has_force() ? "feel_how" : "press_how"));
    } else if (const int said = pair_of_buttons("left", "1", "right", "2"); said != 0) {
      return game.answer(said == 1);
    }
    constexpr double kAxis_s = 10.0;
    draw_difference(game.trace(), std::max(kAxis_s, game.trace().seconds()));
  }

  void draw_slow_motion() {
    const float line = body();
    const ImVec2 at(ImGui::GetCursorScreenPos().x, ImGui::GetCursorScreenPos().y + 0.6F * line);
    const ImVec2 size(ImGui::GetContentRegionAvail().x, std::max(bottom() - line - at.y, 4.0F * line));
    exhibit.reveal_.draw_arrows(style, {at, size}, now_s(), exhibit.colour_of_truth(shown, style.theme()),
                                colour_of(game.computer()), game.round().computer_is_left,
                                [this](double force_N) { return newtons(force_N); });
  }

  void draw_reveal() {
    if (!exhibit.reveal_is_done(shown)) {
      say(words()("slow_motion", fixed(exhibit.times_.slowness, 0)));
      space(0.2F);
      say_quietly(words()("slow_motion_how"));
      return draw_slow_motion();
    }
    const bool right = game.round().correct();
    say_in(style.fonts().big, style.colours().text, words()(right ? "found" : "fooled"));
    const double largest = game.trace().largest_over_jnd();
    say(words()(largest > 1.25 ? "verdict_noticed" : largest < 0.8 ? "verdict_unnoticed" : "verdict_edge"));
    space(0.4F);
    if (button(words()(game.level() + 1 < game.rounds().size() ? "next" : "to_score"), "Enter")) return game.go_on();
    draw_slow_motion();
  }

  // A line about the model of a level, and a bar below it. `band`, `share`: lengths of its frame and of the bar, as
  // shares of the width.
  void draw_bar(std::size_t level, const std::string& line, double band, double share) {
    const ExhibitModel& model = game.line_up().levels[level];
    say_quietly(words()("name_" + kind_of(model), centres_of(model)) + ": " + line);
    const float height = 0.8F * body(), all = ImGui::GetContentRegionAvail().x;
    const ImVec2 at = ImGui::GetCursorScreenPos(), frame(at.x + all * static_cast<float>(band), at.y + height);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(at, frame, ink(style.colours().band));
    list.AddRect(at, frame, ink(style.colours().edge));
    const float filled = share > 0.0 ? std::max(3.0F, all * static_cast<float>(share)) : 0.0F;
    list.AddRectFilled({at.x, at.y + 0.2F * height}, {at.x + filled, at.y + 0.8F * height}, ink(colour_of(model)));
    ImGui::Dummy({1.0F, height});
  }

  // "half a millionth of a second"
  std::string time_words(double tick_ns) const {
    if (tick_ns < 400.0) return words()("time_third");
    if (tick_ns < 750.0) return words()("time_half");
    if (tick_ns < 1500.0) return words()("time_one");
    return words()("time_many", fixed(1e-3 * tick_ns, 0));
  }

  void draw_score() {
    const std::size_t levels = game.rounds().size();
    if (exhibit.farewell_) return draw_farewell(levels);
    say(words()("score"));
    double range = 2.0;
    for (std::size_t i = 0; i < levels; ++i) range = std::max(range, 1.05 * game.largest_over_jnd(i));
    for (std::size_t i = 0; i < levels; ++i) {
      const double largest = game.largest_over_jnd(i);
      const char* found = game.rounds()[i].correct() ? "row_found" : "row_fooled";
      draw_bar(i, number(largest) + ", " + words()(found), 1.0 / range, largest / range);
    }
    say_quietly(words()("bars"));
    space(0.5F);
    exhibit.farewell_ = button(words()("next"), "Enter");
  }

  // The sentence to take home, and the score of the day.
  void draw_farewell(std::size_t levels) {
    const bool hidden = game.largest_over_jnd(levels - 1) <= 1.0;
    // The time of the tick of the best model alone, as everywhere.
    const ModelView& best = shown.models.slots[game.line_up().levels[levels - 1].slot];
    say_long(words()(hidden ? "take_home" : "take_home_noticed", time_words(best.tick_ns())));
    space(0.4F);
    say_quietly(words()("day"));
    for (std::size_t i = 0; i < levels; ++i) {
      const std::uint64_t answers = exhibit.tally_.answers[i], fooled = exhibit.tally_.fooled[i];
      if (answers > 0)  // how many visitors it has fooled
        draw_bar(i, words()("day_of", std::to_string(fooled), std::to_string(answers)), 1.0,
                 static_cast<double>(fooled) / static_cast<double>(answers));
    }
    space(0.5F);
    if (button(words()("again"), "Enter")) exhibit.begin(shown);
  }

  void draw_foot() {
    const double left_s = exhibit.times_.stay_s - (now_s() - exhibit.moved_s_);
    const float line = ImGui::GetFrameHeight();
    ImGui::SetCursorScreenPos(
        {layout.panel.at.x + ImGui::GetStyle().WindowPadding.x, layout.panel.at.y + layout.panel.size.y - 1.5F * line});
    const std::size_t next = (exhibit.language_ + 1) % exhibit.languages_.size();
    if (exhibit.languages_.size() > 1 && ImGui::Button((exhibit.languages_[next]("language") + "  (L)").c_str()))
      exhibit.language_ = next;
    if (game.state() == State::attract || left_s > exhibit.times_.warn_s) return;
    ImGui::SameLine();
    const std::string text = words()("countdown", std::to_string(static_cast<int>(std::ceil(std::max(0.0, left_s)))));
    // More lines begin higher.
    const float more = text_size(style.fonts().body, in_lines(text, ImGui::GetContentRegionAvail().x)).y - body();
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() - more);
    say(text);
  }

  // The host's figures, at the upper edge of the picture.
  void draw_host() const {
    const std::string text = in_lines(health_words(shown.health, 0.0, true).text, layout.scene.size.x - 2.0F * body());
    const ImVec2 size = text_size(style.fonts().body, text), at(layout.scene.at.x + body(), layout.scene.at.y + 4.0F);
    ImDrawList& front = *ImGui::GetForegroundDrawList();
    front.AddRectFilled({at.x - 6.0F, at.y - 2.0F}, {at.x + size.x + 6.0F, at.y + size.y + 2.0F},
                        ink(style.colours().panel));
    front.AddText(style.fonts().body, body(), at, ink(style.colours().text), text.c_str());
    exhibit.said_.push_back(text);
  }

  // Names stand under the blocks only when the answer is given, and in the invitation.
  void draw_names() const {
    if (!exhibit.knows_pair()) return;
    for (const bool left : {true, false}) {
      const bool is_computer = left == exhibit.computer_is_left();
      const bool named =
          game.state() != State::press && (game.state() != State::reveal || exhibit.reveal_is_done(shown));
      const std::string text = !named                                          ? words()(left ? "left" : "right")
                               : is_computer                                   ? words()("name_computer")
                               : exhibit.line_up().truth                       ? words()("name_other")
                               : shown.models.reference_name == "the material" ? words()("name_simulated")
                                                                               : words()("name_measured");
      const Rgb colour = !named        ? style.colours().text
                         : is_computer ? text_colour(colour_of(exhibit.computer()), style.theme())
                                       : text_colour(exhibit.colour_of_truth(shown, style.theme()), style.theme());
      const SceneArea& scene = layout.scene;
      ImFont* font = style.fonts().heading;
      const ImVec2 size = text_size(font, text);
      const glm::vec2 foot = blocks.foot(left ? 0 : 1, 2, {scene.size.x, scene.size.y});
      text_at(font,
              {scene.at.x + std::clamp(foot.x - 0.5F * size.x, 4.0F, std::max(4.0F, scene.size.x - size.x - 4.0F)),
               scene.at.y + std::min(foot.y + 0.6F * size.y, scene.size.y - 1.3F * size.y)},
              ink(colour), text);
    }
  }
};

void Exhibit::draw(const WindowView& shown, const BlockView& blocks, const UiStyle& style, const WindowLayout& layout) {
  if (pointer_moved()) moved_s_ = shown.health.newest.loop_time_s;
  buttons_.clear();
  said_.clear();
  Screens screens{*this, game_, shown, blocks, style, layout};
  begin_panel(kPanelWindow, layout.panel);
  ImGui::PushFont(style.fonts().heading);
  screens.space(0.5F);
  using Draw = void (Screens::*)();
  constexpr Draw kScreens[] = {&Screens::draw_attract, &Screens::draw_press, &Screens::draw_reveal,
                               &Screens::draw_score};  // in the order of State
  (screens.*kScreens[static_cast<std::size_t>(game_.state())])();
  ImGui::PopFont();
  fits_ = ImGui::GetCursorScreenPos().y < screens.bottom() + screens.body();
  screens.draw_foot();
  ImGui::End();
  if (host_) screens.draw_host();
  screens.draw_names();
  pressed_.clear();
}

}  // namespace palpate
