#include "rendering/panels/exhibit.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "scenes/scene/scene.h"

namespace palpate {
namespace {

using State = ExhibitGame::State;

constexpr double kDeviceMoves_m = 5e-4;  // above the noise of a handle at rest
// From the first contact until the press of the largest difference is shown again.
constexpr double kLeastStroke_s = 4.0;
constexpr double kHeld_s = 2.5;  // the moment of the largest difference stands still in attract

std::vector<ExhibitModel> ready_models(const WindowView& shown) {
  std::vector<ExhibitModel> ready;
  for (std::size_t i = 0; i < shown.models.slots.size(); ++i) {
    const ModelView& slot = shown.models.slots[i];
    if (slot.state == SlotState::ready) ready.push_back({i, slot.centres, slot.paper});
  }
  return ready;
}

bool has_reference(const WindowView& shown) {
  return shown.models.compared && shown.models.reference == kReferenceBlock;
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
  moment.true_N = std::lerp(moment.true_N, above.true_N, share);
  moment.over_jnd = std::lerp(moment.over_jnd, above.over_jnd, share);
  return moment;
}

void ExhibitReveal::draw_arrows(const UiStyle& style, const SceneArea& area, double now_s, const Rgb& truth,
                                const Rgb& computer, bool computer_is_left,
                                const std::function<std::string(double)>& newtons) const {
  const Moment moment = at(now_s);
  const auto highest_N = [this](const Moment& one) { return std::max({0.1, one.true_N + jnd_N(one), model_N(one)}); };
  double press_N = 0.1;
  for (const Moment& one : moments_) press_N = std::max(press_N, highest_N(one));
  // During the way back the present arrows may be higher than both.
  const double most_N =
      std::max(std::lerp(press_N, highest_N(moments_[largest_at_]), way_back(now_s)), highest_N(moment));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  // The numbers stand above the arrows, where no line crosses them.
  const float line = 1.3F * ImGui::GetFontSize(), right = area.at.x + area.size.x, ground = area.at.y + area.size.y;
  const auto y_of = [&](double force_N) {
    return ground - (area.size.y - line) * static_cast<float>(std::max(0.0, force_N) / most_N);
  };
  const ImVec2 corner(area.at.x, y_of(moment.true_N + jnd_N(moment)));
  const ImVec2 other(right, y_of(moment.true_N - jnd_N(moment)));
  list.AddRectFilled(corner, other, ink(style.colours().band));
  list.AddRect(corner, other, ink(style.colours().edge));
  const float thick = 3.0F * style.scale(), width = 0.11F * area.size.x, middle = area.at.x + 0.5F * area.size.x;
  // The difference between the tips, in the colour of errors above one JND where it leaves the band.
  list.AddRectFilled({middle - 4.0F * thick, y_of(std::max(moment.true_N, model_N(moment)))},
                     {middle + 4.0F * thick, y_of(std::min(moment.true_N, model_N(moment)))},
                     ink(std::abs(moment.over_jnd) > 1.0 ? kAboveJndColour : style.colours().quiet));
  for (const bool is_computer : {true, false}) {
    const double force_N = std::max(0.0, is_computer ? model_N(moment) : moment.true_N);
    const Rgb& colour = is_computer ? computer : truth;
    const float x = area.at.x + (is_computer == computer_is_left ? 0.25F : 0.75F) * area.size.x, tip = y_of(force_N);
    const float neck = std::min(tip + 1.1F * width, ground);
    list.AddRectFilled({x - 0.3F * width, neck}, {x + 0.3F * width, ground}, ink(colour));
    list.AddTriangleFilled({x, tip}, {x + 0.75F * width, neck}, {x - 0.75F * width, neck}, ink(colour));
    list.AddLine({x, tip}, {middle, tip}, ink(colour), thick);
    const std::string text = newtons(force_N);
    list.AddText({x - 0.5F * ImGui::CalcTextSize(text.c_str()).x, area.at.y - 0.1F * line},
                 ink(text_colour(colour, style.theme())), text.c_str());
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

std::size_t Exhibit::level() const noexcept {
  if (game_.state() != State::attract) return game_.level();
  return repeats_ ? 0 : attraction_.levels.size() - 1;
}

bool Exhibit::computer_is_left() const noexcept {
  return game_.state() == State::attract || game_.round().computer_is_left;
}

bool Exhibit::update(const WindowView& shown, ViewState& view, const WindowActions& actions) {
  note_device(shown);
  const bool here = shown.health.newest.loop_time_s - moved_s_ < times_.stay_s;
  const bool left = visitor_ && !here;
  visitor_ = here;
  if (left) forget(shown, view, actions);
  if (game_.state() == State::attract) choose_attraction(shown);
  read_ticks(shown);
  begin_reveal(shown);
  // Outside attract and press, the tool is kept out of the block, so that the visitor cannot press it.
  const bool pressing = game_.state() == State::press && game_.lifted();
  view.exhibit.tool_is_held = game_.state() != State::attract && !pressing;
  if (view.exhibit.tool_is_held) actions.lift_tool();
  // During a round the simulated hand must not press, even if the visitor does not move.
  if (pressing && shown.tool != nullptr) shown.tool->nudge(0.0, steady_now_s());
  view.exhibit.close_up = game_.state() == State::reveal;
  view.settings.blocks = 2;
  if (knows_pair()) actions.select(game_.state() == State::press ? game_.rendered().slot : computer().slot);
  return left;
}

// Notes the time of a visitor's last movement. A handle at rest does not count, and neither does the simulated hand.
void Exhibit::note_device(const WindowView& shown) {
  const double at_m = shown.health.newest.tick.position_m;
  if (std::abs(at_m - device_at_m_) < kDeviceMoves_m) return;
  device_at_m_ = at_m;
  if (shown.tool != nullptr ? !shown.hand_explores : shown.renders_force) moved_s_ = shown.health.newest.loop_time_s;
}

// Passes on every tick, independent of the frame rate.
void Exhibit::read_ticks(const WindowView& shown) {
  const ForceHistory& history = *shown.history;
  const std::size_t first = history.first_at(std::nextafter(seen_s_, std::numeric_limits<double>::infinity()));
  for (std::size_t next = first; knows_pair() && next < history.size(); ++next) {
    const HistoryPoint& tick = history[next];
    if (game_.state() != State::attract) {
      game_.add(tick);
      continue;
    }
    if (repeats_) continue;
    // Ends in air, or after the longest time.
    const double seconds = best_.seconds();
    if ((seconds > std::min(kLeastStroke_s, 0.5 * times_.press_s) && !tick.in_contact) || seconds >= times_.press_s) {
      repeats_ = true;
      reveal_.start(worst_, shown.models.jnd, 1.0, shown.health.newest.loop_time_s);
      continue;
    }
    best_.add(tick, attraction_, attraction_.levels.size() - 1);
    worst_.add(tick, attraction_, 0);
  }
  if (history.size() > 0) seen_s_ = history[history.size() - 1].loop_time_s;
}

// Chooses the best and the worst model as soon as all are ready, and returns from the worst to the best.
void Exhibit::choose_attraction(const WindowView& shown) {
  if (repeats_ && reveal_.done(shown.health.newest.loop_time_s - kHeld_s)) {
    repeats_ = false;
    best_ = worst_ = {};
  }
  if (ready_ || !shown.settled) return;
  attraction_ = ExhibitGame::line_up_of(ready_models(shown), has_reference(shown), false);
  ready_ = !attraction_.levels.empty();
}

void Exhibit::begin_reveal(const WindowView& shown) {
  if (std::exchange(revealed_, game_.state() == State::reveal) || !revealed_) return;
  reveal_.start(game_.trace(), shown.models.jnd, times_.slowness, shown.health.newest.loop_time_s);
  // Each day has its own file. A score that cannot be written is no error.
  const std::string path = tally_path();
  if (!path.empty()) tally_ = read_tally(path);
  ++tally_.answers[game_.level()];
  if (!game_.round().correct()) ++tally_.fooled[game_.level()];
  if (!path.empty()) (void)write_tally(path, tally_);
}

bool Exhibit::reveal_is_done(const WindowView& shown) const {
  return revealed_ && reveal_.done(shown.health.newest.loop_time_s);
}

Rgb Exhibit::colour_of_truth(const WindowView& shown, Theme theme) const {
  return line_up().truth ? slot_colour(shown.models, line_up().truth->slot, theme) : reference_colour(theme);
}

std::vector<BlockPose> Exhibit::shown_poses(const WindowView& shown, Theme theme) const {
  if (!knows_pair()) return {};
  BlockPose truth, model;
  if (shows_worst() || game_.state() == State::reveal) {
    const ExhibitReveal::Moment moment = reveal_.at(shown.health.newest.loop_time_s);
    truth.tool_m = static_cast<float>(moment.position_m);
    truth.force_N = static_cast<float>(moment.true_N);
    model.force_N = static_cast<float>(reveal_.model_N(moment));
    model.error_over_jnd = static_cast<float>(std::abs(moment.over_jnd));
  } else {
    const HistoryPoint& now = shown.models.now;
    truth.tool_m = now.position_m;
    truth.force_N = static_cast<float>(line_up().true_N(now));
    model.force_N = now.force_N[computer().slot];
    model.error_over_jnd = static_cast<float>(std::abs(line_up().over_jnd(now, level())));
  }
  truth.dent_m = model.dent_m = std::max(0.0F, model.tool_m = truth.tool_m);
  for (BlockPose* pose : {&truth, &model})
    pose->force_N = std::max(0.0F, std::isfinite(pose->force_N) ? pose->force_N : 0.0F);
  if (!std::isfinite(model.error_over_jnd)) model.error_over_jnd = 0.0F;
  // Nothing gives the answer away.
  truth.arrow = is_blind() ? palette(theme).text : colour_of_truth(shown, theme);
  model.arrow = is_blind() ? palette(theme).text : slot_colour(shown.models, computer().slot, theme);
  truth.shows_error = false;
  model.shows_error = !is_blind() && model.dent_m > 0.0F;
  return computer_is_left() ? std::vector{model, truth} : std::vector{truth, model};
}

void Exhibit::begin(const WindowView& shown) {
  farewell_ = false;
  (void)game_.begin(ready_models(shown), has_reference(shown), shown.renders_force);
}

void Exhibit::forget(const WindowView& shown, ViewState& view, const WindowActions& actions) {
  game_.reset();
  ready_ = repeats_ = farewell_ = false;
  best_ = worst_ = {};
  language_ = 0;
  host_ = false;
  actions.reset_figures();
  if (shown.tool != nullptr) shown.tool->release();
  view.time.run();
}

void Exhibit::press_key(int key, const WindowView& shown) {
  moved_s_ = shown.health.newest.loop_time_s;
  if (key == GLFW_KEY_L) language_ = (language_ + 1) % languages_.size();
  if (key == GLFW_KEY_KP_1 || key == GLFW_KEY_KP_2) key += GLFW_KEY_1 - GLFW_KEY_KP_1;
  if (key == GLFW_KEY_LEFT || key == GLFW_KEY_RIGHT) game_.choose(key == GLFW_KEY_LEFT);
  const bool on = key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER || key == GLFW_KEY_SPACE;
  pressed_ = on ? "Enter" : key_name(key);
  // Where there is nothing to choose, 1 and Enter are the same.
  if (buttons_.count("2") == 0 && (on || key == GLFW_KEY_1)) pressed_ = buttons_.count("1") != 0 ? "1" : "Enter";
}

}  // namespace palpate
