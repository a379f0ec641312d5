#include "rendering/panels/open_day.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

#include "engine/live/pacer.h"
#include "rendering/panels/panel_health.h"
#include "rendering/panels/panel_parts.h"

namespace palpate {
namespace {

constexpr auto kVisitorWindow = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                        ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                        ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBackground;
// A device is always there: nobody is when it was not pressed for so long.
constexpr double kAlone_s = 20.0;

std::vector<TrialModel> ready_models(const LiveSession& session) {
  std::vector<TrialModel> ready;
  for (std::size_t i = 0; i < session.models().size(); ++i) {
    const SlotView& slot = session.models().view(i);
    if (slot.state == SlotState::ready) ready.push_back({i, slot.name, slot.method});
  }
  return ready;
}

void wrapped(const std::string& text) { ImGui::TextWrapped("%s", text.c_str()); }

void quiet_wrapped(const UiStyle& style, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, paint(style.colours().quiet));
  wrapped(text);
  ImGui::PopStyleColor();
}

// The colour of its curve before what is said of it.
void patch(const Rgb& colour) {
  const float line = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + 0.25F * line}, {at.x + 0.6F * line, at.y + 0.85F * line},
                                            ink(colour), 0.1F * line);
  ImGui::Dummy({1.0F * line, line});
  ImGui::SameLine(0.0F, 0.0F);
}

}  // namespace

void OpenDay::set_up(std::vector<ExhibitWords> languages, const std::string& tally_path) {
  languages_ = std::move(languages);
  tally_path_ = tally_path;
  if (!tally_path.empty()) tally_ = read_tally(tally_path);
}

bool OpenDay::update(LiveSession& session, ViewState& view) {
  const double now_s = session.newest().loop_time_s;
  const bool moves_by_itself = session.mouse() != nullptr && session.mouse()->hand_is_exploring();
  if (session.newest().tick.in_contact && !moves_by_itself) last_contact_s_ = now_s;
  const bool trying = trial_.state() != AbTrial::State::idle;
  const bool holds_the_mouse = session.mouse() != nullptr && !moves_by_itself;
  const bool visitor = holds_the_mouse || (trying && now_s - last_contact_s_ < kAlone_s);
  const bool left = visitor_ && !visitor;
  if (visitor && !visitor_ && !trying) begin(session, view);
  if (left) forget(session, view);
  visitor_ = visitor;
  update_ticks(session);
  view.hidden_choice = trial_.state() == AbTrial::State::exploring ? trial_.pressed() : 0;
  view.hidden_name = words()(view.hidden_choice == 2 ? "block_2" : "block_1");
  return left;
}

// Every tick counts, however slow the picture is.
void OpenDay::update_ticks(const LiveSession& session) {
  const ForceHistory& history = session.comparison().history();
  if (trial_.state() == AbTrial::State::exploring) {
    std::size_t next = history.first_at(seen_s_);
    while (next < history.size() && history[next].loop_time_s <= seen_s_) ++next;
    for (; next < history.size(); ++next) {
      const HistoryPoint& point = history[next];
      trial_.update(static_cast<double>(point.force_N[trial_.slot_under(1)]),
                 static_cast<double>(point.force_N[trial_.slot_under(2)]), point.in_contact, session.jnd());
    }
  }
  if (history.size() > 0) seen_s_ = history[history.size() - 1].loop_time_s;
}

void OpenDay::begin(LiveSession& session, ViewState& view) {
  if (trial_.state() == AbTrial::State::idle) home_ = session.models().selected();
  view.block_count = 1;
  view.revealed.clear();
  view.time.run();
  began_s_ = steady_now_s();
  last_contact_s_ = session.newest().loop_time_s;
  if (trial_.begin(ready_models(session))) session.select(trial_.slot_under(1));
}

void OpenDay::forget(LiveSession& session, ViewState& view) {
  trial_.reset();
  session.select(home_);
  session.reset_figures();
  language_ = 0;
  const double zero_s = view.time.zero_s;
  view = ViewState{};
  view.time.zero_s = zero_s;
  view.kiosk = true;
  view.block_count = 1;
  view.theme = Theme::dark;
}

void OpenDay::press_key(int key, LiveSession& session, ViewState& view) {
  last_contact_s_ = session.newest().loop_time_s;
  if (key == GLFW_KEY_L) language_ = (language_ + 1) % languages_.size();
  if (trial_.state() != AbTrial::State::answered && (key == GLFW_KEY_1 || key == GLFW_KEY_2))
    try_model(key - GLFW_KEY_0, session, view);
  if (key == GLFW_KEY_D) answer(true, view);
  if (key == GLFW_KEY_S) answer(false, view);
  if (trial_.state() == AbTrial::State::answered && key == GLFW_KEY_N) begin(session, view);
  if (trial_.state() == AbTrial::State::idle && (key == GLFW_KEY_ENTER || key == GLFW_KEY_SPACE)) try_model(1, session, view);
}

void OpenDay::try_model(int number, LiveSession& session, ViewState& view) {
  if (trial_.state() == AbTrial::State::idle) begin(session, view);
  if (trial_.state() == AbTrial::State::idle) return;  // there are no two models yet
  trial_.press(number);
  session.select(trial_.slot_under(number));
}

void OpenDay::answer(bool different, ViewState& view) {
  if (trial_.state() != AbTrial::State::exploring || !trial_.tried_both()) return;
  trial_.answer(different);
  // What was pressed stays to be looked at.
  const double now_s = steady_now_s();
  view.time.zoom(std::clamp(began_s_, now_s - kShown_s, now_s - 2.0), now_s);
  view.revealed = {trial_.slot_under(1), trial_.slot_under(2)};
  view.hidden_choice = 0;
  if (!trial_.touched()) return;
  ++tally_.answers;
  if (different == trial_.predicts_difference()) ++tally_.as_expected;
  // A tally that cannot be kept is no reason to stop.
  if (!tally_path_.empty()) (void)write_tally(tally_path_, tally_);
}

std::string OpenDay::plain_name(const TrialModel& model) const {
  return words()(model.method == "position" ? "knows_depth" : model.method == "direct" ? "learned_all" : "remembers");
}

std::vector<std::string> OpenDay::reveal() const {
  if (trial_.state() != AbTrial::State::answered) return {};
  const bool differ = trial_.predicts_difference();
  std::vector<std::string> lines{words()(trial_.answered_different() ? "said_differ" : "said_same")};
  if (!trial_.touched()) {
    lines.push_back(words()("untouched"));
  } else {
    lines.push_back(words()(differ ? "truth_differ" : "truth_same"));
    lines.push_back(words()(trial_.answered_different() == differ ? "right" : "wrong"));
  }
  for (const int key : {1, 2}) lines.push_back(words()("was", std::to_string(key), plain_name(trial_.under(key))));
  return lines;
}

void OpenDay::draw(LiveSession& session, ViewState& view, const UiStyle& style, const ImVec2& at,
                   const ImVec2& size) {
  buttons_.clear();
  ImGui::SetNextWindowPos(at);
  ImGui::SetNextWindowSize(size);
  ImGui::Begin("visitor", nullptr, kVisitorWindow);
  ImGui::PushFont(style.fonts().heading);
  switch (trial_.state()) {
    case AbTrial::State::idle: draw_nobody(session, view, style, size); break;
    case AbTrial::State::exploring: draw_question(session, view, style); break;
    case AbTrial::State::answered: draw_reveal(session, view, style, 0.36F * size.y); break;
  }
  ImGui::PopFont();
  draw_foot(session, style, at, size);
  ImGui::End();
}

// As wide as it may be, high enough for a finger; in its corner the key that does the same.
bool OpenDay::large_button(const UiStyle& style, const std::string& text, const char* key, float width, bool down) {
  if (down) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyle().Colors[ImGuiCol_ButtonActive]);
  const bool pressed = ImGui::Button(text.c_str(), {width, 2.2F * height_of(style.fonts().heading)});
  if (down) ImGui::PopStyleColor();
  const ImVec2 low = ImGui::GetItemRectMin();
  const ImVec2 corner = ImGui::GetItemRectMax();
  const float line = height_of(style.fonts().body);
  ImGui::GetWindowDrawList()->AddText(style.fonts().body, line, {corner.x - 1.1F * line, corner.y - 1.25F * line},
                                      ink(style.colours().quiet), key);
  buttons_[key] = {0.5F * (low.x + corner.x), 0.5F * (low.y + corner.y)};
  return pressed;
}

void OpenDay::draw_nobody(LiveSession& session, ViewState& view, const UiStyle& style, const ImVec2& size) {
  const float line = height_of(style.fonts().heading);
  ImGui::Dummy({1.0F, std::max(2.0F * line, 0.28F * size.y)});
  wrapped(words()("attract"));
  ImGui::Dummy({1.0F, line});
  if (ready_models(session).size() < 2) {
    quiet_wrapped(style, words()("learning"));
    return;
  }
  quiet_wrapped(style, words()(session.mouse() != nullptr ? "attract_mouse" : "attract_device"));
  ImGui::Dummy({1.0F, line});
  if (large_button(style, words()("begin"), "1", -1.0F, false)) try_model(1, session, view);
}

void OpenDay::draw_question(LiveSession& session, ViewState& view, const UiStyle& style) {
  const bool felt = session.renders_force();
  const float line = height_of(style.fonts().heading);
  ImGui::Dummy({1.0F, line});
  wrapped(words()(felt ? "question_device" : "question_mouse"));
  ImGui::Dummy({1.0F, 0.3F * line});
  quiet_wrapped(style, words()(trial_.tried_both() ? "answer" : felt ? "try_both" : "try_both_mouse"));
  ImGui::Dummy({1.0F, 0.5F * line});
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float half = 0.5F * (ImGui::GetContentRegionAvail().x - gap);
  if (large_button(style, words()("block_1"), "1", half, trial_.pressed() == 1)) try_model(1, session, view);
  ImGui::SameLine();
  if (large_button(style, words()("block_2"), "2", half, trial_.pressed() == 2)) try_model(2, session, view);
  if (trial_.tried_both()) {
    ImGui::Dummy({1.0F, 0.8F * line});
    if (large_button(style, words()("differ"), "D", -1.0F, false)) answer(true, view);
    if (trial_.state() == AbTrial::State::exploring && large_button(style, words()("same"), "S", -1.0F, false))
      answer(false, view);
  }
  if (felt) return;
  ImGui::Dummy({1.0F, 0.8F * line});
  ImGui::PushFont(style.fonts().body);
  quiet_wrapped(style, words()("mouse_cannot"));
  ImGui::PopFont();
}

void OpenDay::draw_reveal(LiveSession& session, ViewState& view, const UiStyle& style, float height) {
  const std::vector<std::string> lines = reveal();
  const std::size_t names = lines.size() - 2;  // the last two say which was which
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i == 1) ImGui::PushFont(style.fonts().body);
    if (i >= names) {
      const std::size_t slot = trial_.under(static_cast<int>(i - names) + 1).slot;
      patch(slot_colour(models_view(session), slot, style.theme()));
    }
    wrapped(lines[i]);
  }
  patch(kReferenceColour);
  wrapped(words()("true_block"));
  curves_.draw_for_visitors(force_view(session), view, style, height);
  quiet_wrapped(style, words()("band"));
  ImGui::PopFont();
  ImGui::Dummy({1.0F, 0.3F * height_of(style.fonts().heading)});
  if (large_button(style, words()("again"), "N", -1.0F, false)) begin(session, view);
  ImGui::PushFont(style.fonts().body);
  quiet_wrapped(style, words()("tally", std::to_string(tally_.answers), std::to_string(tally_.as_expected)));
  ImGui::PopFont();
}

// The next language, and a dot for whoever looks after the exhibit: hollow when the log
// has something to read.
void OpenDay::draw_foot(const LiveSession& session, const UiStyle& style, const ImVec2& at, const ImVec2& size) {
  const float line = ImGui::GetFrameHeight();
  ImGui::SetCursorScreenPos({at.x + ImGui::GetStyle().WindowPadding.x, at.y + size.y - 1.6F * line});
  if (languages_.size() > 1) {
    const std::size_t next = (language_ + 1) % languages_.size();
    if (ImGui::Button((languages_[next]("language") + "  (L)").c_str())) language_ = next;
  }
  const ImVec2 dot(at.x + size.x - line, at.y + size.y - line);
  const ImU32 quiet = ink(style.colours().grid);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (health_words(health_view(session), 0.0).problem) {
    list.AddCircle(dot, 0.2F * line, quiet, 0, 2.0F);
  } else {
    list.AddCircleFilled(dot, 0.2F * line, quiet);
  }
}

}  // namespace palpate
