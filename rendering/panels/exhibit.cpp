#include "rendering/panels/exhibit.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "engine/base/text.h"
#include "engine/live/pacer.h"
#include "rendering/panels/scene_overlay.h"
#include "scenes/scene/scene.h"

namespace palpate {
namespace {

using State = ExhibitGame::State;

constexpr double kLifted_m = -0.008;     // position of the tool while it is kept out of the block
constexpr double kDeviceMoves_m = 5e-4;  // above the noise of a handle at rest
// From the first contact until the press of the largest difference is shown again.
constexpr double kLeastStroke_s = 4.0;
constexpr double kHeld_s = 2.5;  // the moment of the largest difference stands still in attract

std::vector<ExhibitModel> ready_models(const LiveSession& session) {
  std::vector<ExhibitModel> ready;
  for (std::size_t i = 0; i < session.models().size(); ++i) {
    const ModelInfo& slot = session.models().info(i);
    if (slot.state == SlotState::ready) ready.push_back({i, slot.centres, slot.paper});
  }
  return ready;
}

bool has_reference(const LiveSession& session) { return session.comparison().reference() != ReferenceKind::model; }

ExhibitTick tick_of(const HistoryPoint& point, const ExhibitRound& round) {
  const std::size_t second = round.second.slot;
  ExhibitTick tick;
  tick.loop_time_s = point.loop_time_s;
  tick.first_N = round.first ? point.force_N[round.first->slot] : point.reference_N;
  tick.second_N = point.force_N[second];
  tick.over_jnd = point.sustained_over_jnd[second];
  if (round.first) tick.over_jnd -= point.sustained_over_jnd[round.first->slot];
  tick.in_contact = point.in_contact;
  tick.out_of_domain = point.out_of_domain;
  tick.position_m = point.position_m;
  return tick;
}

// In columns: the longest parts of the press before and after the largest difference that are shown, and the approach
// before it.
constexpr std::size_t kBefore = static_cast<std::size_t>(1.0 / ExhibitTrace::kColumn_s);
constexpr std::size_t kAfter = static_cast<std::size_t>(0.6 / ExhibitTrace::kColumn_s);
constexpr std::size_t kApproach = static_cast<std::size_t>(0.15 / ExhibitTrace::kColumn_s);

bool is_pressed(const ExhibitTrace::Column& column) { return column.ticks > 0 && column.position_m > 0.0; }

}  // namespace

void ExhibitReveal::start(const ExhibitTrace& trace, const JndLine& jnd, double slowness, double now_s) {
  jnd_ = jnd;
  slowness_ = slowness;
  began_s_ = now_s;
  moments_.assign(1, {});
  largest_at_ = 0;
  const std::vector<Moment>& columns = trace.columns();
  if (columns.empty()) return;
  const std::size_t largest = trace.largest_at();
  std::size_t first = largest, last = largest;
  while (first > 0 && largest - first < kBefore && is_pressed(columns[first - 1])) --first;
  while (last + 1 < columns.size() && last - largest < kAfter && is_pressed(columns[last + 1])) ++last;
  for (std::size_t i = 0; i < kApproach && first > 0 && columns[first - 1].ticks > 0; ++i) --first;
  moments_ = {columns.begin() + static_cast<std::ptrdiff_t>(first),
              columns.begin() + static_cast<std::ptrdiff_t>(last + 1)};
  largest_at_ = largest - first;
}

double ExhibitReveal::way_back(double now_s) const noexcept {
  const double share = std::clamp((columns_since_start(now_s) - end()) / kBack, 0.0, 1.0);
  return share * share * (3.0 - 2.0 * share);
}

double ExhibitReveal::playhead(double now_s) const noexcept {
  const double pressed = std::clamp(columns_since_start(now_s), 0.0, end());
  return std::lerp(pressed, static_cast<double>(largest_at_), way_back(now_s));
}

ExhibitReveal::Moment ExhibitReveal::at(double now_s) const noexcept {
  const double at = playhead(now_s);
  const auto below = static_cast<std::size_t>(at);
  const Moment& above = moments_[std::min(below + 1, moments_.size() - 1)];
  const double share = at - static_cast<double>(below);
  Moment moment = moments_[below];
  moment.position_m = std::lerp(moment.position_m, above.position_m, share);
  moment.first_N = std::lerp(moment.first_N, above.first_N, share);
  moment.over_jnd = std::lerp(moment.over_jnd, above.over_jnd, share);
  return moment;
}

void ExhibitReveal::draw_arrows(const UiStyle& style, const SceneArea& area, double now_s, const Rgb& first,
                                const Rgb& second, bool first_is_left) const {
  const Moment moment = at(now_s);
  const auto highest_N = [this](const Moment& one) { return std::max({0.1, one.first_N + jnd_N(one), second_N(one)}); };
  double press_N = 0.1;
  for (const Moment& one : moments_) press_N = std::max(press_N, highest_N(one));
  // During the way back the present arrows may be higher than both.
  const double most_N =
      std::max(std::lerp(press_N, highest_N(moments_[largest_at_]), way_back(now_s)), highest_N(moment));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float right = area.at.x + area.size.x, ground = area.at.y + area.size.y;
  const auto y_of = [&](double force_N) {
    return ground - area.size.y * static_cast<float>(std::max(0.0, force_N) / most_N);
  };
  const ImVec2 corner(area.at.x, y_of(moment.first_N + jnd_N(moment)));
  const ImVec2 other(right, y_of(moment.first_N - jnd_N(moment)));
  list.AddRectFilled(corner, other, ink(style.colours().band));
  list.AddRect(corner, other, ink(style.colours().edge));
  const float thick = 3.0F * style.scale(), width = 0.11F * area.size.x, middle = area.at.x + 0.5F * area.size.x;
  // The difference between the tips, in the colour of errors above one JND where it leaves the band.
  list.AddRectFilled({middle - 4.0F * thick, y_of(std::max(moment.first_N, second_N(moment)))},
                     {middle + 4.0F * thick, y_of(std::min(moment.first_N, second_N(moment)))},
                     ink(std::abs(moment.over_jnd) > 1.0 ? kAboveJndColour : style.colours().quiet));
  for (const bool is_first : {true, false}) {
    const double force_N = std::max(0.0, is_first ? moment.first_N : second_N(moment));
    const Rgb& colour = is_first ? first : second;
    const float x = area.at.x + (is_first == first_is_left ? 0.25F : 0.75F) * area.size.x, tip = y_of(force_N);
    const float neck = std::min(tip + 1.1F * width, ground);
    list.AddRectFilled({x - 0.3F * width, neck}, {x + 0.3F * width, ground}, ink(colour));
    list.AddTriangleFilled({x, tip}, {x + 0.75F * width, neck}, {x - 0.75F * width, neck}, ink(colour));
    list.AddLine({x, tip}, {middle, tip}, ink(colour), thick);
    const std::string text = fixed(force_N, 1) + " N";
    const float y = std::max(area.at.y - 1.1F * ImGui::GetFontSize(), tip - 1.2F * ImGui::GetFontSize());
    list.AddText({x - 0.5F * ImGui::CalcTextSize(text.c_str()).x, y}, ink(text_colour(colour, style.theme())),
                 text.c_str());
  }
  list.AddLine({area.at.x, ground}, {right, ground}, ink(style.colours().quiet), thick);
}

void Exhibit::set_up(std::vector<ExhibitWords> languages, const std::string& tally_folder, const ExhibitTimes& times) {
  languages_ = std::move(languages);
  tally_folder_ = tally_folder;
  times_ = times;
  tally_ = read_tally(tally_path());
}

std::string Exhibit::tally_path() const {
  return tally_folder_.empty() ? "" : tally_folder_ + local_time_text("/exhibit-%Y%m%d.txt");
}

const ExhibitRound* Exhibit::pair() const noexcept {
  if (game_.state() != State::attract) return &game_.round();
  return ready_ ? &(repeats_ ? worst_ : best_).round : nullptr;
}

bool Exhibit::update(LiveSession& session, ViewState& view) {
  note_device(session);
  const bool here = session.newest().loop_time_s - moved_s_ < times_.stay_s;
  const bool left = visitor_ && !here;
  visitor_ = here;
  if (left) forget(session, view);
  if (game_.state() == State::attract) choose_attraction(session);
  read_ticks(session);
  begin_reveal(session);
  // Outside attract and press, the tool is kept out of the block, so that the visitor cannot press it.
  view.exhibit.tool_is_held = game_.state() != State::attract && game_.state() != State::press;
  if (view.exhibit.tool_is_held) let_go(session);
  // During a round the simulated hand must not press, even if the visitor does not move.
  if (game_.state() == State::press && session.tool_input() != nullptr)
    session.tool_input()->nudge(0.0, steady_now_s());
  const ExhibitRound* now = pair();
  const bool blind = game_.state() == State::press && game_.has_force();
  view.exhibit.blind = blind;
  view.exhibit.close_up = game_.state() == State::reveal;
  const bool one_block = game_.has_force() && game_.state() != State::attract && game_.state() != State::reveal;
  view.settings.blocks = one_block ? 1 : 2;
  if (now != nullptr) session.models().select(blind ? game_.rendered().slot : now->second.slot);
  return left;
}

// Notes the time of a visitor's last movement. A handle at rest does not count, and neither does the simulated hand.
void Exhibit::note_device(const LiveSession& session) {
  const double at_m = session.newest().tick.position_m;
  if (std::abs(at_m - device_at_m_) < kDeviceMoves_m) return;
  device_at_m_ = at_m;
  const ToolInput* tool = session.tool_input();
  const bool somebody = tool != nullptr ? !tool->hand_is_exploring() : session.renders_force();
  if (somebody) moved_s_ = session.newest().loop_time_s;
}

// Passes on every tick, independent of the frame rate.
void Exhibit::read_ticks(const LiveSession& session) {
  const ForceHistory& history = session.comparison().history();
  const ExhibitRound* now = pair();
  const auto seconds = [&] { return best_.trace.seconds(); };
  const std::size_t first = history.first_at(std::nextafter(seen_s_, std::numeric_limits<double>::infinity()));
  for (std::size_t next = first; now != nullptr && next < history.size(); ++next) {
    const ExhibitTick tick = tick_of(history[next], *now);
    if (game_.state() != State::attract) {
      game_.add(tick);
      continue;
    }
    if (repeats_) continue;
    // Ends in air, or after the time of a round.
    if ((seconds() > std::min(kLeastStroke_s, 0.5 * times_.press_s) && !tick.in_contact) ||
        seconds() >= times_.press_s) {
      repeats_ = best_.trace.strong();
      if (repeats_) reveal_.start(worst_.trace, session.jnd(), 1.0, session.newest().loop_time_s);
      if (!repeats_) forget_strokes();
      continue;
    }
    best_.trace.add(tick);
    worst_.trace.add(tick_of(history[next], worst_.round));
  }
  if (history.size() > 0) seen_s_ = history[history.size() - 1].loop_time_s;
}

// Chooses the best and the worst model as soon as all are ready, and returns from the worst to the best.
void Exhibit::choose_attraction(const LiveSession& session) {
  const double now_s = session.newest().loop_time_s;
  if (repeats_ && reveal_.done(now_s - kHeld_s)) {
    repeats_ = false;
    forget_strokes();
  }
  if (ready_ || !session.models().all_settled()) return;
  const auto rounds = ExhibitGame::rounds_of(ready_models(session), has_reference(session), false);
  if (rounds.empty()) return;
  best_.round = rounds.back();
  worst_.round = rounds.front();
  ready_ = true;
}

void Exhibit::forget_strokes() {
  best_.trace.clear();
  worst_.trace.clear();
}

void Exhibit::let_go(LiveSession& session) {
  if (session.tool_input() != nullptr) session.tool_input()->set_target(kLifted_m, steady_now_s());
}

void Exhibit::begin_reveal(const LiveSession& session) {
  if (std::exchange(revealed_, game_.state() == State::reveal) || !revealed_) return;
  reveal_.start(game_.trace(), session.jnd(), times_.slowness, session.newest().loop_time_s);
  // Each day has its own tally file. A tally that cannot be written is no error.
  const std::string path = tally_path();
  if (!path.empty()) tally_ = read_tally(path);
  ++tally_.answers;
  if (game_.round().correct()) ++tally_.as_expected;
  if (!path.empty()) (void)write_tally(path, tally_);
}

bool Exhibit::reveal_is_done(const LiveSession& session) const {
  return revealed_ && reveal_.done(session.newest().loop_time_s);
}

Rgb Exhibit::colour_of(bool first, const WindowView& shown, Theme theme) const {
  const ExhibitRound& round = *pair();
  if (first && !round.first) return reference_colour(theme);
  return slot_colour(shown.models, first ? round.first->slot : round.second.slot, theme);
}

std::vector<BlockPose> Exhibit::shown_poses(const LiveSession& session, const WindowView& shown, Theme theme) const {
  if (!shows_worst() && (game_.state() != State::reveal || !revealed_)) return {};
  const ExhibitReveal::Moment moment = reveal_.at(session.newest().loop_time_s);
  BlockPose first;
  first.tool_m = static_cast<float>(moment.position_m);
  first.dent_m = std::max(0.0F, first.tool_m);
  first.force_N = static_cast<float>(moment.first_N);
  first.arrow = colour_of(true, shown, theme);
  first.shows_error = false;
  BlockPose second = first;
  second.force_N = static_cast<float>(std::max(0.0, reveal_.second_N(moment)));
  second.error_over_jnd = static_cast<float>(std::abs(moment.over_jnd));
  second.arrow = colour_of(false, shown, theme);
  second.shows_error = true;
  return first_is_left() ? std::vector{first, second} : std::vector{second, first};
}

void Exhibit::begin(const LiveSession& session) {
  (void)game_.begin(ready_models(session), has_reference(session), session.renders_force(), times_.press_s);
}

void Exhibit::forget(LiveSession& session, ViewState& view) {
  game_.reset();
  ready_ = repeats_ = false;
  forget_strokes();
  language_ = 0;
  host_ = false;
  session.reset_figures();
  if (session.tool_input() != nullptr) session.tool_input()->release();
  view.time.run();
}

void Exhibit::press_key(int key, const LiveSession& session) {
  moved_s_ = session.newest().loop_time_s;
  if (key == GLFW_KEY_L) language_ = (language_ + 1) % languages_.size();
  if (key == GLFW_KEY_KP_1 || key == GLFW_KEY_KP_2) key += GLFW_KEY_1 - GLFW_KEY_KP_1;
  const bool on = key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER || key == GLFW_KEY_SPACE;
  pressed_ = on ? "Enter" : key_name(key);
  // Where there is nothing to choose, 1 and Enter are the same.
  if (buttons_.count("2") == 0 && (on || key == GLFW_KEY_1)) pressed_ = buttons_.count("1") != 0 ? "1" : "Enter";
}

}  // namespace palpate
