// Draws the screens of the exhibit.
#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "rendering/panels/exhibit.h"
#include "rendering/panels/panel.h"

namespace palpate {
namespace {

using State = ExhibitGame::State;

constexpr double kMost_jnd = 4.0;  // fixed range of the axis, so that rounds are comparable

bool pointer_moved() {
  const ImGuiIO& io = ImGui::GetIO();
  return io.MouseDelta.x != 0.0F || io.MouseDelta.y != 0.0F || io.MouseWheel != 0.0F || ImGui::IsAnyMouseDown();
}

}  // namespace

struct Exhibit::Screens {
  Exhibit& exhibit;
  ExhibitGame& game;
  const LiveSession& session;
  const WindowView& shown;
  const BlockView& blocks;
  const UiStyle& style;
  const WindowLayout& layout;

  const ExhibitWords& words() const { return exhibit.words(); }
  // The end of the panel above the foot.
  float bottom() const { return layout.panel.at.y + layout.panel.size.y - 2.6F * body(); }
  float body() const { return height_of(style.fonts().body); }
  double now_s() const { return session.newest().loop_time_s; }
  void space(float lines) const { ImGui::Dummy({1.0F, lines * body()}); }
  static std::string centres_of(const ExhibitModel& model) { return std::to_string(model.centres); }
  // The ending of the keys of the texts about a model. A trend without a correction has no centres.
  static std::string kind_of(const ExhibitModel& model) {
    return model.paper ? "paper" : model.centres > 0 ? "best" : "trend";
  }
  Rgb colour_of(const ExhibitModel& model) const { return slot_colour(shown.models, model.slot, style.theme()); }

  // The number with the digits that a reader needs.
  std::string number(double value) const {
    if (value <= 0.0) return "0";
    std::string text = fixed(std::max(0.01, value), value < 1.0 ? 2 : 1);
    if (const std::size_t at = text.find('.'); at != std::string::npos) text.replace(at, 1, words()("decimal"));
    return text;
  }

  std::string verdict() const {
    const ExhibitRound& round = game.round();
    if (round.is_catch()) return words()("verdict_catch");
    if (round.near_jnd()) return words()("verdict_edge");
    return words()(round.noticed() ? "verdict_noticed" : "verdict_unnoticed");
  }

  void say(const std::string& text) {
    ImGui::TextUnformatted(in_lines(text, ImGui::GetContentRegionAvail().x).c_str());
    exhibit.said_.push_back(text);
  }

  void say_in(ImFont* font, const Rgb& colour, const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, paint(colour));
    ImGui::PushFont(font);
    say(text);
    ImGui::PopFont();
    ImGui::PopStyleColor();
  }
  void say_quietly(const std::string& text) { say_in(style.fonts().body, style.colours().quiet, text); }

  void say_round() {
    say_quietly(words()("round", std::to_string(game.number()), std::to_string(game.rounds().size())));
  }

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

  void draw_difference(const ExhibitTrace& trace) {
    // Outside the plot, where no curve crosses them.
    say_quietly(words()("axis_difference"));
    const double largest = trace.largest_over_jnd();
    say_quietly(largest > 0.0 ? words()("so_far", number(largest)) : words()("in_band"));
    ImGui::PushFont(style.fonts().body);  // of the axes
    const float height = std::max(bottom() - ImGui::GetCursorScreenPos().y, 6.0F * body());
    const LivePlot plot(style, {ImGui::GetContentRegionAvail().x, height},
                        {{0.0, exhibit.times_.press_s}, {-kMost_jnd, kMost_jnd}, "s", ""});
    ImGui::PopFont();
    plot.jnd_band(-1.0, 1.0);
    plot.level(0.0, ink(reference_colour(style.theme())), 4.0F * style.scale());
    std::vector<ImVec2> points;
    const auto flush = [&] {
      // In attract without the colour of a model, which round 1 shows again.
      const Rgb colour = game.state() == State::attract ? style.colours().text : colour_of(exhibit.pair()->second);
      plot.line(points, ink(colour), 4.0F * style.scale());
      points.clear();
    };
    for (std::size_t i = 0; i < trace.columns().size(); ++i) {
      const double over_jnd = trace.columns()[i].over_jnd;
      if (std::isnan(over_jnd)) {
        flush();
      } else {
        points.emplace_back(plot.x_px(static_cast<double>(i) * ExhibitTrace::kColumn_s),
                            plot.y_px(std::clamp(over_jnd, -kMost_jnd, kMost_jnd)));
      }
    }
    flush();
  }

  void draw_attract() {
    say(words()("attract"));
    space(0.3F);
    say_quietly(words()("attract_more"));
    space(0.6F);
    if (exhibit.pair() == nullptr) return draw_learning();
    if (button(words()("play"), "1")) return exhibit.begin(session);
    space(0.6F);
    say(words()(exhibit.shows_worst() ? "attract_worst" : "attract_best"));
    draw_difference(exhibit.attract_trace());
  }

  void draw_learning() {
    say_quietly(words()("learning"));
    float done = 0.0F;
    for (const ModelView& slot : shown.models.slots)
      done += slot.state == SlotState::ready ? 1.0F : static_cast<float>(slot.progress);
    const auto all = static_cast<float>(std::max<std::size_t>(shown.models.slots.size(), 1));
    ImGui::ProgressBar(done / all, {-1.0F, 0.8F * body()}, "");
  }

  void draw_guess() {
    say_round();
    const ExhibitModel& model = game.round().second;
    say(words()("hint_" + kind_of(model), centres_of(model)));
    space(0.6F);
    say(words()("question_guess"));
    space(0.4F);
    const ImVec2 half(-1.0F, 0.5F * (bottom() - ImGui::GetCursorScreenPos().y - ImGui::GetStyle().ItemSpacing.y));
    ImGui::PushFont(style.fonts().big);
    if (button(words()("yes"), "1", half)) game.guess(true);
    if (button(words()("no"), "2", half)) game.guess(false);
    ImGui::PopFont();
  }

  void draw_press() {
    say_round();
    if (!game.has_force()) {
      say(words()("press"));
      say_quietly(words()("press_how"));
      space(0.6F);
      return draw_difference(game.trace());
    }
    say(words()("question_feel"));
    say_quietly(words()(game.pressed_both() ? "answer" : "feel_both"));
    space(0.4F);
    const ImVec2 half(0.5F * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x), 0.0F);
    if (button(words()("block_1"), "1", half, game.chosen() == 1)) game.choose(1);
    ImGui::SameLine();
    if (button(words()("block_2"), "2", half, game.chosen() == 2)) game.choose(2);
    if (!game.pressed_both()) return;
    space(0.8F);
    if (button(words()("differ"), words()("key_differ"))) return game.answer(true);
    if (button(words()("same"), words()("key_same"))) game.answer(false);
  }

  void draw_key(const ExhibitModel& model, const char* block) {
    say_in(style.fonts().heading, text_colour(colour_of(model), style.theme()),
           words()(block) + ": " + words()("name_" + kind_of(model), centres_of(model)));
  }

  void draw_slow_motion() {
    const float line = body();
    const ImVec2 at(ImGui::GetCursorScreenPos().x, ImGui::GetCursorScreenPos().y + line);
    const ImVec2 size(ImGui::GetContentRegionAvail().x, std::max(bottom() - 1.6F * line - at.y, 4.0F * line));
    const Theme theme = style.theme();
    exhibit.reveal_.draw_arrows(style, {at, size}, now_s(), exhibit.colour_of(true, shown, theme),
                                exhibit.colour_of(false, shown, theme), exhibit.first_is_left());
  }

  void draw_reveal() {
    const ExhibitRound& round = game.round();
    if (!exhibit.reveal_is_done(session)) {
      say(words()("slow_motion", fixed(exhibit.times_.slowness, 0)));
      space(0.2F);
      say_quietly(words()("slow_motion_how"));
      return draw_slow_motion();
    }
    const bool edge = round.near_jnd() && !round.is_catch();
    say_in(style.fonts().big, style.colours().text, words()(edge ? "edge" : round.correct() ? "right" : "wrong"));
    say(verdict());
    space(0.4F);
    if (button(words()(game.number() < game.rounds().size() ? "next" : "to_score"), "Enter")) return game.go_on();
    if (game.has_force()) {  // shows which model had which key
      space(0.4F);
      draw_key(*round.first, "block_1");
      draw_key(round.second, "block_2");
    }
    draw_slow_motion();
  }

  void draw_bar(const ExhibitRound& round) {
    const std::string name = round.is_catch() ? "name_catch" : "name_" + kind_of(round.second);
    say_quietly(words()(name, centres_of(round.second)) + ": " + number(round.largest_over_jnd) + ", " +
                words()(round.correct() ? "row_right" : "row_wrong"));
    const float height = 0.8F * body();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float jnd = ImGui::GetContentRegionAvail().x / static_cast<float>(kMost_jnd);
    const auto length = static_cast<float>(std::clamp(round.largest_over_jnd, 0.02, kMost_jnd));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(at, {at.x + jnd, at.y + height}, ink(style.colours().band));
    list.AddRect(at, {at.x + jnd, at.y + height}, ink(style.colours().edge));
    list.AddRectFilled({at.x, at.y + 0.2F * height}, {at.x + length * jnd, at.y + 0.8F * height},
                       ink(colour_of(round.second)));
    ImGui::Dummy({1.0F, height});
  }

  void draw_score() {
    const std::vector<ExhibitRound>& rounds = game.rounds();
    say(words()("score"));
    say_in(style.fonts().big, style.colours().text,
           words()("score_of", std::to_string(game.correct_answers()), std::to_string(rounds.size())));
    space(0.4F);
    for (const ExhibitRound& round : rounds) draw_bar(round);
    say_quietly(words()("bars"));
    space(0.4F);
    // The time of the tick of the best model alone, as everywhere.
    const std::string used_us = number(1e-3 * shown.models.slots[rounds.back().second.slot].tick_ns());
    say(game.has_force() ? words()("take_home_felt", used_us)
                         : words()("take_home", number(rounds.back().largest_over_jnd), used_us));
    space(0.4F);
    if (button(words()("again"), "Enter")) exhibit.begin(session);
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
    say(words()("countdown", std::to_string(static_cast<int>(std::ceil(std::max(0.0, left_s))))));
  }

  void draw_host() {
    ImGui::SetCursorScreenPos({layout.panel.at.x + 0.4F * layout.panel.size.x, layout.panel.at.y + 2.0F});
    ImGui::PushFont(style.fonts().body);
    exhibit.said_.push_back(
        words()("tally", std::to_string(exhibit.tally_.answers), std::to_string(exhibit.tally_.as_expected)));
    ImGui::TextUnformatted((exhibit.said_.back() + "\n" + health_words(shown.health, 0.0, true).text).c_str());
    ImGui::PopFont();
  }

  std::string name_of(bool first) const {
    if (!first) return words()("name_computer");
    if (exhibit.pair()->first) return words()("name_other");
    return words()(session.comparison().reference() == ReferenceKind::measured ? "name_measured" : "name_simulated");
  }

  void draw_name(std::size_t index, std::size_t count, const std::string& text, const Rgb& colour) const {
    const SceneArea& scene = layout.scene;
    ImFont* font = style.fonts().heading;
    const ImVec2 size = text_size(font, text);
    const glm::vec2 foot = blocks.foot(index, count, {scene.size.x, scene.size.y});
    text_at(font,
            {scene.at.x + std::clamp(foot.x - 0.5F * size.x, 4.0F, scene.size.x - size.x - 4.0F),
             scene.at.y + std::min(foot.y + 0.6F * size.y, scene.size.y - 1.3F * size.y)},
            ink(colour), text);
  }

  // Says on the picture that the blocks cannot be pressed yet.
  void draw_answer_first() const {
    const SceneArea& scene = layout.scene;
    const std::string& text = words()("answer_first");
    ImFont* font = style.fonts().big;
    const ImVec2 size = text_size(font, text, 0.9F * scene.size.x);
    const ImVec2 at(scene.at.x + 0.5F * (scene.size.x - size.x), scene.at.y + 0.16F * scene.size.y);
    text_at(font, at, ink(style.colours().text), text, 0.9F * scene.size.x);
  }

  void draw_names() const {
    if (exhibit.pair() == nullptr) return;
    if (game.state() == State::guess) draw_answer_first();
    const bool revealed = game.state() == State::reveal;
    const bool blind = game.state() != State::attract && game.has_force() && !revealed;
    const std::size_t count = blind ? 1 : 2;
    const Theme theme = style.theme();
    for (std::size_t i = 0; i < count; ++i) {
      const bool first = (i == 0) == exhibit.first_is_left();
      std::string text = blind ? words()(game.chosen() == 2 ? "block_2" : "block_1") : name_of(first);
      if (blind && game.state() != State::press) text.clear();
      if (game.has_force() && revealed) text = words()(first ? "block_1" : "block_2");
      const Rgb colour = exhibit.colour_of(first, shown, theme);
      draw_name(i, count, text, blind ? style.colours().text : text_colour(colour, theme));
    }
  }
};

void Exhibit::draw(const LiveSession& session, const WindowView& shown, const BlockView& blocks, const UiStyle& style,
                   const WindowLayout& layout) {
  if (pointer_moved()) moved_s_ = session.newest().loop_time_s;
  buttons_.clear();
  said_.clear();
  Screens screens{*this, game_, session, shown, blocks, style, layout};
  begin_panel("visitor", layout.panel);
  ImGui::PushFont(style.fonts().heading);
  screens.space(0.5F);
  using Draw = void (Screens::*)();
  constexpr Draw kScreens[] = {&Screens::draw_attract, &Screens::draw_guess, &Screens::draw_press,
                               &Screens::draw_reveal, &Screens::draw_score};  // in the order of State
  (screens.*kScreens[static_cast<std::size_t>(game_.state())])();
  ImGui::PopFont();
  screens.draw_foot();
  if (host_) screens.draw_host();
  ImGui::End();
  screens.draw_names();
  pressed_.clear();
}

}  // namespace palpate
