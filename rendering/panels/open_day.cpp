#include "rendering/panels/open_day.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <string>

#include "rendering/panels/panel_health.h"
#include "rendering/ui/plot.h"

namespace palpate {
namespace {

constexpr auto kVisitorWindow = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                        ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                        ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBackground;

std::vector<TrialModel> ready_models(const LiveSession& session) {
  std::vector<TrialModel> ready;
  for (std::size_t i = 0; i < session.models().size(); ++i) {
    const SlotView& slot = session.models().view(i);
    if (slot.state == SlotState::ready) ready.push_back({i, slot.name, slot.method});
  }
  return ready;
}

}  // namespace

void OpenDay::update(LiveSession& session, ViewState& view) {
  const bool visitor =
      session.mouse() != nullptr ? !session.mouse()->hand_is_exploring() : trial_.state() != AbTrial::State::idle;
  if (visitor && !visitor_) begin(session, view);
  if (!visitor && visitor_) forget(session, view);
  visitor_ = visitor;
  if (trial_.state() == AbTrial::State::exploring) {
    trial_.see(session.models().view(trial_.slot_under(1)).force_N, session.models().view(trial_.slot_under(2)).force_N,
               session.newest().tick.in_contact, session.jnd());
  }
  view.hidden_choice = trial_.state() == AbTrial::State::exploring ? trial_.pressed() : 0;
}

void OpenDay::begin(LiveSession& session, ViewState& view) {
  if (trial_.state() == AbTrial::State::idle) home_ = session.models().selected();
  view.block_count = 1;
  if (trial_.begin(ready_models(session))) session.select(trial_.slot_under(1));
}

void OpenDay::forget(LiveSession& session, ViewState& view) {
  trial_.reset();
  session.select(home_);
  session.reset_figures();
  const double zero_s = view.time.zero_s;
  view = ViewState{};
  view.time.zero_s = zero_s;
  view.kiosk = true;
  view.theme = Theme::dark;
}

void OpenDay::press_key(int key, LiveSession& session, ViewState& view) {
  if (key == GLFW_KEY_1 || key == GLFW_KEY_2) try_model(key - GLFW_KEY_0, session, view);
  if (trial_.state() == AbTrial::State::exploring && trial_.tried_both()) {
    if (key == GLFW_KEY_D) trial_.answer(true);
    if (key == GLFW_KEY_S) trial_.answer(false);
  }
  if (trial_.state() == AbTrial::State::answered && key == GLFW_KEY_N) begin(session, view);
}

void OpenDay::try_model(int number, LiveSession& session, ViewState& view) {
  if (trial_.state() == AbTrial::State::idle) begin(session, view);
  if (trial_.state() == AbTrial::State::idle) return;  // there are no two models yet
  trial_.press(number);
  session.select(trial_.slot_under(number));
}

void OpenDay::draw(LiveSession& session, ViewState& view, const UiStyle& style, const ImVec2& at,
                   const ImVec2& size) {
  ImGui::SetNextWindowPos(at);
  ImGui::SetNextWindowSize(size);
  ImGui::Begin("visitor", nullptr, kVisitorWindow);
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::TextWrapped("A computer learned this block from one recording and pushes back as the block did.");
  ImGui::Spacing();
  curves_.draw_for_visitors(force_view(session), view, style, std::max(6.0F * line, 0.36F * size.y));
  ImGui::TextDisabled("Inside the grey band a hand cannot tell.");
  ImGui::Dummy({0.0F, 0.4F * line});
  draw_trial(style, width);
  const HealthWords health = health_words(health_view(session), 0.0);
  if (health.problem) {
    ImGui::PushStyleColor(ImGuiCol_Text, paint(style.colours().fault));
    ImGui::TextWrapped("%s", health.text.c_str());
    ImGui::PopStyleColor();
  }
  ImGui::End();
}

void OpenDay::draw_trial(const UiStyle& style, float width) const {
  ImGui::PushFont(style.fonts().heading);
  switch (trial_.state()) {
    case AbTrial::State::idle:
      ImGui::TextWrapped("Move the mouse over the block.");
      break;
    case AbTrial::State::exploring:
      ImGui::TextWrapped("Can you feel the difference?");
      break;
    case AbTrial::State::answered:
      ImGui::TextWrapped(trial_.answered_different() ? "You felt a difference." : "You felt none.");
      break;
  }
  ImGui::PopFont();
  if (trial_.state() == AbTrial::State::idle) {
    ImGui::TextWrapped(
        "Slowly, and it gives way. Quickly, and it resists. Hold still, and the force fades: it remembers "
        "what you did.");
    ImGui::Spacing();
    ImGui::TextDisabled("Until then a hand presses by itself.");
    return;
  }
  draw_keys(style, width);
  if (trial_.state() == AbTrial::State::answered) {
    ImGui::TextWrapped("%s", trial_.verdict().c_str());
    ImGui::TextDisabled("N: once more");
  } else if (trial_.tried_both()) {
    ImGui::TextWrapped("Press D if they differ, S if they feel the same.");
  } else {
    ImGui::TextWrapped("Keys 1 and 2 change the block. Press it with both.");
  }
}

void OpenDay::draw_keys(const UiStyle& style, float width) const {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  ImFont* font = style.fonts().heading;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float side = 1.7F * height_of(font);
  for (const int key : {1, 2}) {
    const float x = at.x + (key == 1 ? 0.0F : side + 0.5F * height_of(font));
    const bool down = trial_.pressed() == key;
    list.AddRectFilled({x, at.y}, {x + side, at.y + side},
                       ink(down ? style.colours().text : style.colours().raised), 8.0F);
    const char text[2] = {static_cast<char>('0' + key), '\0'};
    const ImVec2 size = font->CalcTextSizeA(height_of(font), 1e6F, 0.0F, text);
    list.AddText(font, height_of(font), {x + 0.5F * (side - size.x), at.y + 0.5F * (side - size.y)},
                 ink(down ? style.colours().panel : style.colours().text), text);
  }
  ImGui::Dummy({width, side + 0.3F * height_of(font)});
}

}  // namespace palpate
