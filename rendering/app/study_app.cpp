#include "rendering/app/study_app.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "rendering/panels/panel.h"
#include "scenes/scene/scene.h"

namespace palpate {
namespace {

constexpr float kColumnShare = 0.62F;     // of the window's width
constexpr std::size_t kLongestCode = 12;  // longer than valid codes, so that a code that is too long is reported
constexpr Theme kTheme = Theme::dark;     // avoids glare in a dim room

void gap() { ImGui::Dummy({1.0F, 0.6F * ImGui::GetFontSize()}); }

}  // namespace

Result<std::unique_ptr<StudyApp>> StudyApp::create(const WindowRequest& asked, const std::string& device,
                                                   const std::function<Strokes()>& prepare, bool realtime) {
  if (Status status = Window::find_display(); !status) return status.error();
  auto window = Window::open(asked);
  if (!window) return window.error();
  std::unique_ptr<StudyApp> app(new StudyApp);
  app->window_ = std::move(*window);
  GLFWwindow* handle = app->window_->handle();
  glfwSetWindowUserPointer(handle, app.get());
  glfwSetKeyCallback(handle, [](GLFWwindow* from, int key, int, int action, int) {
    if (action == GLFW_PRESS) static_cast<StudyApp*>(glfwGetWindowUserPointer(from))->press_key(key);
  });
  glfwSetCharCallback(handle, [](GLFWwindow* from, unsigned letter) {
    if (letter < 0x80) static_cast<StudyApp*>(glfwGetWindowUserPointer(from))->type(static_cast<char>(letter));
  });
  // After these callbacks: ImGui installs its own and calls them.
  app->ui_ = std::make_unique<UiContext>(handle);
  std::shared_ptr<const StrokePair> strokes;
  if (prepare) {
    for (int i = 0; i < 2; ++i) {  // a new window may lose its first frame
      glfwPollEvents();
      app->draw();
      app->window_->show_frame();
    }
    auto made = prepare();
    if (!made) return made.error();
    strokes = std::move(*made);
  }
  auto study = LiveStudy::open(device, realtime, std::move(strokes));
  if (!study) return study.error();
  app->study_ = std::move(*study);
  // Removes the force; the answers so far are in the file.
  Window::at_loss_of_display([&owner = app->study_] { owner.reset(); });
  return app;
}

bool StudyApp::closing() const noexcept { return glfwWindowShouldClose(window_->handle()) != 0; }

void StudyApp::frame() {
  glfwPollEvents();
  study_->update();
  draw();
  window_->show_frame();
}

Status StudyApp::screenshot(const std::string& path, bool overwrite) {
  draw();
  return window_->save_frame(path, overwrite);
}

void StudyApp::press_key(int key) {
  if (key == GLFW_KEY_BACKSPACE && !code_.empty()) code_.pop_back();
  // The keypad has the same keys.
  if (key == GLFW_KEY_KP_1 || key == GLFW_KEY_KP_2) key += GLFW_KEY_1 - GLFW_KEY_KP_1;
  pressed_.push_back(key == GLFW_KEY_KP_ENTER ? GLFW_KEY_ENTER : key);
}

void StudyApp::type(char letter) {
  const auto typed = static_cast<unsigned char>(letter);
  if (std::isalnum(typed) != 0 && code_.size() < kLongestCode) code_ += static_cast<char>(std::toupper(typed));
}

void StudyApp::draw() {
  style_.update(window_->size(), kExhibitText, kTheme);
  ui_->begin_frame();
  window_->clear(style_.colours().background);
  const ImVec2 all = ImGui::GetIO().DisplaySize;
  begin_panel("study", {{0.5F * (1.0F - kColumnShare) * all.x, 0.15F * all.y}, {kColumnShare * all.x, 0.82F * all.y}});
  ImGui::PushTextWrapPos();
  study_ == nullptr ? ImGui::Text("The strokes are prepared, one moment ...") : draw_study();
  ImGui::PopTextWrapPos();
  ImGui::End();
  ImGui::Render();
  UiContext::draw_front();
  pressed_.clear();
}

void StudyApp::draw_study() {
  session() == nullptr ? draw_entry() : draw_session();
  gap();
  if (const std::string words = study_->device_words(); !words.empty()) ImGui::Text("%s", words.c_str());
  if (study_->needs_zeroing() && button("Zero here (Z)", GLFW_KEY_Z)) study_->start_zeroing();
  const ImVec4 warning = paint(style_.colours().fault);
  if (session() == nullptr && !problem_.empty()) ImGui::TextColored(warning, "%s", problem_.c_str());
  if (!study_->device_pushes()) {
    ImGui::TextColored(warning,
                       "This device renders no force. This is a rehearsal; its answers are marked and excluded "
                       "from the analysis.");
  }
}

bool StudyApp::button(const char* label, int key, ImVec2 size) {
  return ImGui::Button(label, size) || std::find(pressed_.begin(), pressed_.end(), key) != pressed_.end();
}

void StudyApp::draw_entry() {
  const bool strokes = study_->strokes() != nullptr;
  ImGui::PushFont(style_.fonts().heading);
  ImGui::Text("%s",
              strokes ? "Can a hand feel the difference of two strokes?" : "How small a difference can a hand feel?");
  ImGui::PopFont();
  ImGui::Spacing();
  ImGui::Text("%s The code stands for the person; no name is kept.",
              strokes ? "Three pushes, one after the other: which of the last two was like the first? 100 trials."
                      : "Two pushes, one after the other: which was larger? 320 trials.");
  gap();
  ImGui::PushFont(style_.fonts().heading);
  ImGui::Text("Subject code, such as S01: %s|", code_.c_str());
  gap();
  if (button("Begin (Enter)", GLFW_KEY_ENTER)) {
    const Status begun = study_->begin(code_);
    problem_ = begun ? "" : begun.error().message;
  }
  ImGui::PopFont();
  ImGui::TextDisabled("A code that has begun goes on after its last answer.");
}

void StudyApp::draw_session() {
  const StudyView view = session()->view();
  if (view.state != StudyState::consent) {
    ImGui::TextDisabled("%s   %zu of %zu", view.training ? "training" : "study", view.answered, view.trials);
    const float share = static_cast<float>(view.answered) / static_cast<float>(view.trials);
    ImGui::ProgressBar(share, {-1.0F, 0.4F * ImGui::GetFontSize()}, "");
  }
  ImGui::Spacing();
  ImGui::PushFont(style_.fonts().heading);
  ImGui::Text("%s", view.message.c_str());
  if (view.was_correct && view.training && view.state == StudyState::presenting && view.interval < 0)
    ImGui::TextDisabled(*view.was_correct ? "The last answer was right." : "The last answer was wrong.");
  gap();
  if (view.state == StudyState::presenting || view.state == StudyState::answering) draw_intervals(view);
  draw_choices(view);
  ImGui::PopFont();
}

// A box for each push, the reference included if there is one. The current one is highlighted; the answer is a box.
void StudyApp::draw_intervals(const StudyView& view) {
  const float side = 2.4F * height_of(style_.fonts().big);
  ImGui::PushFont(style_.fonts().big);
  for (int interval = study_->strokes() != nullptr ? 0 : 1; interval <= 2; ++interval) {
    const Rgb colour = view.interval == interval ? reference_colour(style_.theme()) : style_.colours().raised;
    ImGui::PushStyleColor(ImGuiCol_Button, paint(colour));
    const char label[2] = {"R12"[interval], '\0'};
    const bool early = last_ != view.state || slip_left_s_ > 0.0;
    if (button(label, GLFW_KEY_0 + interval, {side, side}) && interval > 0 && !early) session()->answer(interval == 2);
    ImGui::PopStyleColor();
    ImGui::SameLine(0.0F, 0.3F * side);
  }
  ImGui::PopFont();
  ImGui::NewLine();
  gap();
}

void StudyApp::draw_choices(const StudyView& view) {
  // Nobody decides within a quarter of a second after the last push.
  constexpr double kSlip_s = 0.25;
  slip_left_s_ = last_ != view.state ? kSlip_s : slip_left_s_ - window_->frame_s();
  last_ = view.state;
  StudySession& shown = *session();
  if (view.rest_ticks_left > 0) {
    ImGui::TextDisabled("%llu s left", static_cast<unsigned long long>((view.rest_ticks_left + 999) / 1000));
  } else if (view.state == StudyState::consent) {
    if (button("I have read this and agree (Y)", GLFW_KEY_Y)) shown.accept_consent(local_time_text("%Y-%m-%d %H:%M"));
  } else if (view.state == StudyState::ready || view.state == StudyState::rest) {
    if (button("Go on (Enter)", GLFW_KEY_ENTER)) shown.proceed();
  }
  draw_end();
}

void StudyApp::draw_end() {
  const StudyState state = session()->state();
  gap();
  ImGui::PushFont(style_.fonts().body);
  if (state == StudyState::done || state == StudyState::aborted) {
    if (button("Close (Enter)", GLFW_KEY_ENTER)) glfwSetWindowShouldClose(window_->handle(), GLFW_TRUE);
  } else if (asks_end_) {
    ImGui::Text("End the session? The answers so far are kept.");
    if (button("End it (E)", GLFW_KEY_E)) session()->abort();
    ImGui::SameLine();
    if (button("No, go on (Esc)", GLFW_KEY_ESCAPE)) asks_end_ = false;
  } else if (button("End the session (Esc)", GLFW_KEY_ESCAPE)) {
    asks_end_ = true;
  }
  ImGui::PopFont();
}

}  // namespace palpate
