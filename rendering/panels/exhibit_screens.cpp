// Draws the screens of the exhibit.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "engine/base/text.h"
#include "rendering/panels/exhibit.h"
#include "rendering/panels/panel_health.h"
#include "rendering/panels/panel_parts.h"

namespace palpate {
namespace {

using State = ExhibitGame::State;

constexpr auto kVisitorWindow = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                                ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBackground;
constexpr double kMost_jnd = 4.0;  // fixed range of the axis, so that rounds are comparable
constexpr double kPerSecond = 1.0 / ExhibitTrace::kColumn_s;

bool pointer_moved() {
  const ImGuiIO& io = ImGui::GetIO();
  return io.MouseDelta.x != 0.0F || io.MouseDelta.y != 0.0F || io.MouseWheel != 0.0F || ImGui::IsAnyMouseDown();
}

// Breaks lines at blanks only; Dear ImGui would also break after the decimal point of a number.
std::string in_lines(const std::string& text, float width) {
  std::string lines, line;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::string longer = line.empty() ? word : line + " " + word;
    const bool fits = line.empty() || ImGui::CalcTextSize(longer.c_str()).x <= width;
    if (!fits) lines += line + "\n";
    line = fits ? longer : word;
  }
  return lines + line;
}

void space(const UiStyle& style, float lines) { ImGui::Dummy({1.0F, lines * height_of(style.fonts().body)}); }

}  // namespace

struct Exhibit::Canvas {
  const LiveSession& session;
  const WindowView& shown;
  const UiStyle& style;
  SceneArea panel;
  float foot = 0.0F;  // height of the foot
  int centres(const ExhibitModel& model) const { return shown.models.slots[model.slot].centres; }
  std::string centres_of(const ExhibitModel& model) const { return std::to_string(centres(model)); }
  // The ending of the keys of the texts about a model. A trend without a correction has no centres.
  std::string kind_of(const ExhibitModel& model) const {
    if (model.paper) return "paper";
    if (model.method == "position") return "depth";
    if (model.method != "greedy") return "other";
    return centres(model) > 0 ? "best" : "trend";
  }
  Rgb colour_of(const ExhibitModel& model) const { return exhibit_colour(model.method, model.paper, style.theme()); }
};

std::string Exhibit::name_of(bool first, const LiveSession& session) const {
  if (!first) return words()("name_computer");
  if (pair()->first) return words()("name_other");
  return words()(session.comparison().reference() == ReferenceKind::measured ? "name_measured" : "name_simulated");
}

Rgb Exhibit::first_colour(Theme theme) const {
  const auto& first = pair()->first;
  return first ? exhibit_colour(first->method, first->paper, theme) : reference_colour(theme);
}

Rgb Exhibit::second_colour(Theme theme) const {
  return exhibit_colour(pair()->second.method, pair()->second.paper, theme);
}

// The number with the digits that a reader needs.
std::string Exhibit::number(double value) const {
  if (value <= 0.0) return "0";
  std::string text = fixed(std::max(0.01, value), value < 1.0 ? 2 : 1);
  if (const std::size_t at = text.find('.'); at != std::string::npos) text.replace(at, 1, words()("decimal"));
  return text;
}

std::string Exhibit::verdict() const {
  const ExhibitRound& round = game_.round();
  if (round.is_catch()) return words()("verdict_catch");
  if (round.near_jnd()) return words()("verdict_edge");
  return words()(round.noticed() ? "verdict_noticed" : "verdict_unnoticed");
}

void Exhibit::say(const std::string& text) {
  ImGui::TextUnformatted(in_lines(text, ImGui::GetContentRegionAvail().x).c_str());
  said_.push_back(text);
}

void Exhibit::say_quietly(const Canvas& canvas, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, paint(canvas.style.colours().quiet));
  ImGui::PushFont(canvas.style.fonts().body);
  say(text);
  ImGui::PopFont();
  ImGui::PopStyleColor();
}

void Exhibit::draw(const LiveSession& session, const WindowView& shown, const BlockView& blocks, const UiStyle& style,
                   const WindowLayout& layout) {
  if (pointer_moved()) moved_s_ = session.newest().loop_time_s;
  buttons_.clear();
  said_.clear();
  const Canvas canvas{session, shown, style, layout.panel, 2.6F * height_of(style.fonts().body)};
  ImGui::SetNextWindowPos(layout.panel.at);
  ImGui::SetNextWindowSize(layout.panel.size);
  ImGui::Begin("visitor", nullptr, kVisitorWindow);
  ImGui::PushFont(style.fonts().heading);
  space(style, 0.5F);
  switch (game_.state()) {
    case State::attract:
      draw_attract(canvas);
      break;
    case State::guess:
      draw_guess(canvas);
      break;
    case State::press:
      draw_press(canvas);
      break;
    case State::reveal:
      draw_reveal(canvas);
      break;
    case State::score:
      draw_score(canvas);
      break;
  }
  ImGui::PopFont();
  draw_foot(canvas);
  if (host_) draw_host(canvas);
  ImGui::End();
  draw_names(canvas, blocks, layout.scene);
  if (game_.state() == State::reveal) draw_growing_number(canvas, layout.scene);
}

// A button that is high enough for a finger, with its key in the corner.
bool Exhibit::button(const Canvas& canvas, const std::string& text, const std::string& key, float width, bool down) {
  if (down) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyle().Colors[ImGuiCol_ButtonActive]);
  const bool pressed = ImGui::Button(text.c_str(), {width, 2.2F * height_of(canvas.style.fonts().heading)});
  if (down) ImGui::PopStyleColor();
  const ImVec2 low = ImGui::GetItemRectMin();
  const ImVec2 corner = ImGui::GetItemRectMax();
  ImFont* font = canvas.style.fonts().body;
  const float line = height_of(font);
  const float wide = font->CalcTextSizeA(line, 1e6F, 0.0F, key.c_str()).x;
  ImGui::GetWindowDrawList()->AddText(font, line, {corner.x - wide - 0.4F * line, corner.y - 1.2F * line},
                                      ink(canvas.style.colours().quiet), key.c_str());
  buttons_[key] = {0.5F * (low.x + corner.x), 0.5F * (low.y + corner.y)};
  return pressed;
}

void Exhibit::draw_attract(const Canvas& canvas) {
  say(words()("attract"));
  space(canvas.style, 0.3F);
  say_quietly(canvas, words()("attract_more"));
  space(canvas.style, 0.6F);
  if (pair() == nullptr) return draw_learning(canvas);
  if (button(canvas, words()("play"), "1", -1.0F)) begin(canvas.session);
  space(canvas.style, 0.6F);
  draw_difference(canvas, trace_, times_.press_s);
}

// Until the first models are ready: the progress of the fits, and the force of the block that the hand presses.
void Exhibit::draw_learning(const Canvas& canvas) {
  say_quietly(canvas, words()("learning"));
  float done = 0.0F;
  for (const ModelView& slot : canvas.shown.models.slots)
    done += slot.state == SlotState::ready ? 1.0F : static_cast<float>(slot.progress);
  const auto all = static_cast<float>(std::max<std::size_t>(canvas.shown.models.slots.size(), 1));
  ImGui::ProgressBar(done / all, {-1.0F, 0.8F * height_of(canvas.style.fonts().body)}, "");
  space(canvas.style, 0.6F);
  const float height = begin_plot(canvas, words()("axis_force"));
  {
    const ForceHistory& history = *canvas.shown.history;
    const double now_s = canvas.session.newest().loop_time_s;
    const std::size_t first = history.first_at(now_s - times_.press_s);
    constexpr std::size_t kMostPoints = 600;
    const std::size_t step = (history.size() - first) / kMostPoints + 1;
    std::vector<ImVec2> points;
    const LivePlot plot(canvas.style, {ImGui::GetContentRegionAvail().x, height},
                        {{-times_.press_s, 0.0}, {0.0, 1.6 * canvas.shown.usual_force_N}, "s", "N", true});
    for (std::size_t i = first - first % step; i < history.size(); i += step) {
      const auto force_N = static_cast<double>(history[i].reference_N);
      if (!std::isnan(force_N)) points.emplace_back(plot.x_px(history[i].loop_time_s - now_s), plot.y_px(force_N));
    }
    plot.line(points, ink(reference_colour(canvas.style.theme())), 4.0F * canvas.style.scale());
  }
  ImGui::PopFont();
}

void Exhibit::draw_guess(const Canvas& canvas) {
  say_quietly(canvas, words()("round", std::to_string(game_.number()), std::to_string(game_.rounds().size())));
  const ExhibitModel& model = game_.round().second;
  say(words()("hint_" + canvas.kind_of(model), canvas.centres_of(model)));
  say(words()("question_guess"));
  space(canvas.style, 0.4F);
  const float half = 0.5F * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
  std::optional<bool> noticed;
  if (button(canvas, words()("yes"), "1", half)) noticed = true;
  ImGui::SameLine();
  if (button(canvas, words()("no"), "2", half)) noticed = false;
  space(canvas.style, 0.6F);
  draw_difference(canvas, game_.trace(), times_.press_s);
  if (noticed) game_.guess(*noticed);
}

void Exhibit::draw_press(const Canvas& canvas) {
  say_quietly(canvas, words()("round", std::to_string(game_.number()), std::to_string(game_.rounds().size())));
  if (!game_.has_force()) {
    say(words()("press"));
    say_quietly(canvas, words()("press_how"));
    space(canvas.style, 0.6F);
    draw_difference(canvas, game_.trace(), times_.press_s);
    return;
  }
  say(words()("question_feel"));
  say_quietly(canvas, words()(game_.pressed_both() ? "answer" : "feel_both"));
  space(canvas.style, 0.4F);
  const float half = 0.5F * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
  if (button(canvas, words()("block_1"), "1", half, game_.chosen() == 1)) game_.choose(1);
  ImGui::SameLine();
  if (button(canvas, words()("block_2"), "2", half, game_.chosen() == 2)) game_.choose(2);
  if (!game_.pressed_both()) return;
  space(canvas.style, 0.8F);
  std::optional<bool> different;
  if (button(canvas, words()("differ"), words()("key_differ"), -1.0F)) different = true;
  if (button(canvas, words()("same"), words()("key_same"), -1.0F)) different = false;
  if (different) game_.answer(*different);
}

void Exhibit::draw_reveal(const Canvas& canvas) {
  const ExhibitRound& round = game_.round();
  if (!reveal_is_done(canvas.session)) {
    say(words()("slow_motion", fixed(times_.slowness, 0)));
    space(canvas.style, 0.2F);
    say_quietly(canvas, words()("slow_motion_how"));
    return draw_slow_motion(canvas);
  }
  const bool edge = round.near_jnd() && !round.is_catch();
  ImGui::PushFont(canvas.style.fonts().big);
  say(words()(edge ? "edge" : round.correct() ? "right" : "wrong"));
  ImGui::PopFont();
  say(verdict());
  space(canvas.style, 0.4F);
  if (button(canvas, words()(game_.number() < game_.rounds().size() ? "next" : "to_score"), "Enter", -1.0F)) {
    leave_reveal();
    return;
  }
  if (game_.has_force()) {  // shows which model had which key
    space(canvas.style, 0.4F);
    draw_key(canvas, *round.first, "block_1");
    draw_key(canvas, round.second, "block_2");
  }
  draw_slow_motion(canvas);
}

// Draws the arrows in the rest of the panel.
void Exhibit::draw_slow_motion(const Canvas& canvas) {
  const float line = height_of(canvas.style.fonts().body);
  const float top = ImGui::GetCursorScreenPos().y + line;
  const float bottom = canvas.panel.at.y + canvas.panel.size.y - canvas.foot - 1.6F * line;
  const float left = ImGui::GetCursorScreenPos().x;
  const float width = ImGui::GetContentRegionAvail().x;
  const Theme theme = canvas.style.theme();
  reveal_.draw_arrows(canvas.style, {{left, top}, {width, std::max(bottom - top, 4.0F * line)}},
                      canvas.session.newest().loop_time_s, first_colour(theme), second_colour(theme), first_is_left());
}

// Draws the largest difference so far over the blocks.
void Exhibit::draw_growing_number(const Canvas& canvas, const SceneArea& scene) {
  const double largest = reveal_.largest_over_jnd(canvas.session.newest().loop_time_s);
  const Palette& p = canvas.style.colours();
  ImFont* big = canvas.style.fonts().big;
  ImFont* font = canvas.style.fonts().heading;
  const float room = 0.93F * scene.size.x;
  float y = scene.at.y + 0.8F * height_of(font);
  const auto centred = [&](ImFont* with, float scale, const std::string& text, ImU32 colour) {
    const float height = scale * height_of(with);
    std::istringstream lines(text);
    for (std::string one; std::getline(lines, one); y += height) {
      const float wide = with->CalcTextSizeA(height, 1e6F, 0.0F, one.c_str()).x;
      ImGui::GetBackgroundDrawList()->AddText(with, height, {scene.at.x + 0.5F * (scene.size.x - wide), y}, colour,
                                              one.c_str());
    }
  };
  centred(big, 1.4F, number(largest), ink(largest > 1.0 ? text_colour(kAboveJndColour, canvas.style.theme()) : p.text));
  ImGui::PushFont(font);  // in_lines measures with it
  centred(font, 1.0F, in_lines(words()("reveal_times"), room), ink(p.text));
  ImGui::PopFont();
}

void Exhibit::draw_key(const Canvas& canvas, const ExhibitModel& model, const char* block) {
  ImGui::PushStyleColor(ImGuiCol_Text, paint(text_colour(canvas.colour_of(model), canvas.style.theme())));
  say(words()(block) + ": " + words()("name_" + canvas.kind_of(model), canvas.centres_of(model)));
  ImGui::PopStyleColor();
}

void Exhibit::draw_score(const Canvas& canvas) {
  const std::vector<ExhibitRound>& rounds = game_.rounds();
  say(words()("score"));
  ImGui::PushFont(canvas.style.fonts().big);
  say(words()("score_of", std::to_string(game_.correct_answers()), std::to_string(rounds.size())));
  ImGui::PopFont();
  space(canvas.style, 0.4F);
  for (const ExhibitRound& round : rounds) draw_bar(canvas, round);
  say_quietly(canvas, words()("bars"));
  space(canvas.style, 0.4F);
  // The time of a whole tick, including both blocks and the device.
  const std::string used_us = number(canvas.session.loop().statistics().tick.p50_us);
  say(game_.has_force() ? words()("take_home_felt", used_us)
                        : words()("take_home", number(rounds.back().largest_over_jnd), used_us));
  space(canvas.style, 0.4F);
  if (button(canvas, words()("again"), "Enter", -1.0F)) begin(canvas.session);
}

// Draws the largest difference of a round as a bar, in JND.
void Exhibit::draw_bar(const Canvas& canvas, const ExhibitRound& round) {
  const std::string name = round.is_catch() ? "name_catch" : "name_" + canvas.kind_of(round.second);
  say_quietly(canvas, words()(name, canvas.centres_of(round.second)) + ": " + number(round.largest_over_jnd) + ", " +
                          words()(round.correct() ? "row_right" : "row_wrong"));
  const float height = 0.8F * height_of(canvas.style.fonts().body);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float jnd = ImGui::GetContentRegionAvail().x / static_cast<float>(kMost_jnd);
  const auto length = static_cast<float>(std::clamp(round.largest_over_jnd, 0.02, kMost_jnd));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + jnd, at.y + height}, ink(canvas.style.colours().band));
  list.AddRect(at, {at.x + jnd, at.y + height}, ink(canvas.style.colours().edge));
  list.AddRectFilled({at.x, at.y + 0.2F * height}, {at.x + length * jnd, at.y + 0.8F * height},
                     ink(canvas.colour_of(round.second)));
  ImGui::Dummy({1.0F, height});
}

// Draws the title of the curve, and returns the remaining height.
float Exhibit::begin_plot(const Canvas& canvas, const std::string& title) {
  say_quietly(canvas, title);
  ImGui::PushFont(canvas.style.fonts().body);
  const float left = canvas.panel.at.y + canvas.panel.size.y - canvas.foot - ImGui::GetCursorScreenPos().y;
  return std::max(left, 6.0F * height_of(canvas.style.fonts().body));
}

void Exhibit::draw_difference(const Canvas& canvas, const ExhibitTrace& trace, double right_s) {
  // Outside the plot, where no curve crosses them.
  say_quietly(canvas, words()("axis_difference"));
  const double largest = trace.largest_over_jnd();
  const float height = begin_plot(canvas, largest > 0.0 ? words()("so_far", number(largest)) : words()("in_band"));
  {
    const LivePlot plot(canvas.style, {ImGui::GetContentRegionAvail().x, height},
                        {{0.0, right_s}, {-kMost_jnd, kMost_jnd}, "s", "", true});
    plot.jnd_band(-1.0, 1.0);
    plot.level(0.0, ink(reference_colour(canvas.style.theme())), 4.0F * canvas.style.scale());
    std::vector<ImVec2> points;
    const auto flush = [&] {
      plot.line(points, ink(canvas.colour_of(pair()->second)), 4.0F * canvas.style.scale());
      points.clear();
    };
    for (std::size_t i = 0; i < trace.columns().size(); ++i) {
      const double over_jnd = trace.over_jnd(i);
      if (std::isnan(over_jnd)) {
        flush();
      } else {
        points.emplace_back(plot.x_px(static_cast<double>(i) / kPerSecond),
                            plot.y_px(std::clamp(over_jnd, -kMost_jnd, kMost_jnd)));
      }
    }
    flush();
  }
  ImGui::PopFont();
}

// Draws the button of the next language and the countdown.
void Exhibit::draw_foot(const Canvas& canvas) {
  const double left_s = times_.stay_s - (canvas.session.newest().loop_time_s - moved_s_);
  const float line = ImGui::GetFrameHeight();
  ImGui::SetCursorScreenPos(
      {canvas.panel.at.x + ImGui::GetStyle().WindowPadding.x, canvas.panel.at.y + canvas.panel.size.y - 1.5F * line});
  const std::size_t next = (language_ + 1) % languages_.size();
  if (languages_.size() > 1 && ImGui::Button((languages_[next]("language") + "  (L)").c_str())) language_ = next;
  if (game_.state() == State::attract || left_s > times_.warn_s) return;
  ImGui::SameLine();
  say(words()("countdown", std::to_string(static_cast<int>(std::ceil(std::max(0.0, left_s))))));
}

// Draws the information for the host.
void Exhibit::draw_host(const Canvas& canvas) {
  ImGui::SetCursorScreenPos({canvas.panel.at.x + 0.4F * canvas.panel.size.x, canvas.panel.at.y + 2.0F});
  ImGui::PushFont(canvas.style.fonts().body);
  said_.push_back(words()("tally", std::to_string(tally_.answers), std::to_string(tally_.as_expected)));
  ImGui::TextUnformatted((said_.back() + "\n" + health_words(canvas.shown.health, 0.0).text).c_str());
  ImGui::PopFont();
}

// Draws the name of each block at its foot.
void Exhibit::draw_names(const Canvas& canvas, const BlockView& blocks, const SceneArea& scene) const {
  if (pair() == nullptr) return;
  const bool revealed = game_.state() == State::reveal;
  const bool blind = game_.state() != State::attract && game_.has_force() && !revealed;
  const std::size_t count = blind ? 1 : 2;
  const BlockGeometry& block = blocks.geometry();
  ImFont* font = canvas.style.fonts().heading;
  for (std::size_t i = 0; i < count; ++i) {
    const bool first = (i == 0) == first_is_left();
    std::string text = blind ? words()(game_.chosen() == 2 ? "block_2" : "block_1") : name_of(first, canvas.session);
    if (blind && game_.state() != State::press) text.clear();
    if (game_.has_force() && revealed) text = words()(first ? "block_1" : "block_2");
    const ImVec2 size = font->CalcTextSizeA(height_of(font), 1e6F, 0.0F, text.c_str());
    const glm::vec2 foot = blocks.on_screen(
        i, count, {0.0F, -1.05F * static_cast<float>(block.height_m), 0.5F * static_cast<float>(block.length_m)},
        {scene.size.x, scene.size.y});
    const Theme theme = canvas.style.theme();
    const Rgb colour =
        blind ? canvas.style.colours().text : text_colour(first ? first_colour(theme) : second_colour(theme), theme);
    ImGui::GetBackgroundDrawList()->AddText(
        font, height_of(font),
        {scene.at.x + std::clamp(foot.x - 0.5F * size.x, 4.0F, scene.size.x - size.x - 4.0F),
         scene.at.y + std::min(foot.y + 0.6F * size.y, scene.size.y - 1.3F * size.y)},
        ink(colour), text.c_str());
  }
}

}  // namespace palpate
