#include "rendering/app/study_app.h"

#include <epoxy/gl.h>
// GLFW after epoxy, which declares the functions of OpenGL.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <cctype>
#include <utility>

#include "scenes/scene/user_folders.h"
#include "scenes/study/discrimination.h"
#include "scenes/study/prepare_strokes.h"

namespace palpate {
namespace {

constexpr float kColumnShare = 0.62F;     // of the window's width
constexpr std::size_t kLongestCode = 12;  // longer than valid codes, so that a code that is too long is reported
constexpr Theme kTheme = Theme::dark;     // avoids glare in a dim room

constexpr auto kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                        ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoNav;

// A choice of the subject in a state of the session: a button and its key.
struct Choice {
  StudyState state;
  int key;
  const char* label;
  void (*run)(StudySession& session);
};
void go_on(StudySession& session) { session.proceed(); }
constexpr Choice kChoices[] = {
    {StudyState::consent, GLFW_KEY_Y, "I have read this and agree (Y)",
     [](StudySession& session) { session.accept_consent(local_time_text("%Y-%m-%d %H:%M")); }},
    {StudyState::ready, GLFW_KEY_ENTER, "Go on (Enter)", go_on},
    {StudyState::rest, GLFW_KEY_ENTER, "Go on (Enter)", go_on},
    {StudyState::answering, GLFW_KEY_1, "The first (1)", [](StudySession& session) { session.answer(false); }},
    {StudyState::answering, GLFW_KEY_2, "The second (2)", [](StudySession& session) { session.answer(true); }}};

// Replaces a key of the keypad by the usual key.
int usual_key(int key) {
  if (key == GLFW_KEY_KP_ENTER) return GLFW_KEY_ENTER;
  return key == GLFW_KEY_KP_1 || key == GLFW_KEY_KP_2 ? GLFW_KEY_1 + key - GLFW_KEY_KP_1 : key;
}

// Vertical space between groups of elements.
void gap() { ImGui::Dummy({1.0F, 0.6F * ImGui::GetFontSize()}); }

}  // namespace

Result<std::unique_ptr<StudyApp>> StudyApp::create(const StudyRequest& request) {
  if (Status status = Window::find_display(); !status) return status.error();
  auto window = Window::open(request.window);
  if (!window) return window.error();
  auto study = LiveStudy::open(request.device, request.realtime, request.strokes);
  if (!study) return study.error();
  std::unique_ptr<StudyApp> app(new StudyApp);
  app->window_ = std::move(*window);
  app->study_ = std::move(*study);
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
  return app;
}

bool StudyApp::closing() const noexcept { return glfwWindowShouldClose(window_->handle()) != 0; }

void StudyApp::frame() {
  glfwPollEvents();
  study_->update();
  for (const Typed& typed : std::exchange(typed_, {})) {
    if (session() == nullptr) {
      handle_entry(usual_key(typed.key), typed.letter);
    } else {
      handle_key(usual_key(typed.key));
    }
  }
  draw();
  window_->show_frame();
}

Status StudyApp::screenshot(const std::string& path, bool overwrite) {
  draw();
  return window_->save_frame(path, overwrite);
}

void StudyApp::handle_entry(int key, char letter) {
  const auto typed = static_cast<unsigned char>(letter);
  if (std::isalnum(typed) != 0 && code_.size() < kLongestCode) code_ += static_cast<char>(std::toupper(typed));
  if (key == GLFW_KEY_BACKSPACE && !code_.empty()) code_.pop_back();
  if (key != GLFW_KEY_ENTER) return;
  const Status begun = study_->begin(code_);
  problem_ = begun ? "" : begun.error().message;
}

void StudyApp::handle_key(int key) {
  if (key == GLFW_KEY_ESCAPE) session()->abort();
  if (key == GLFW_KEY_Z) study_->start_zeroing();
  const StudyState state = session()->state();
  for (const Choice& choice : kChoices) {
    if (choice.state == state && choice.key == key) choice.run(*session());
  }
}

void StudyApp::draw() {
  const Framebuffer picture = window_->framebuffer();
  style_.update(window_->ui_size(), kExhibitText, kTheme);
  ui_->begin_frame();
  const Rgb& background = style_.colours().background;
  glViewport(0, 0, picture.width, picture.height);
  glClearColor(background.r, background.g, background.b, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT);
  const ImVec2 all = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5F * (1.0F - kColumnShare) * all.x, 0.15F * all.y});
  ImGui::SetNextWindowSize({kColumnShare * all.x, 0.82F * all.y});
  ImGui::Begin("study", nullptr, kFixed);
  session() == nullptr ? draw_entry() : draw_session();
  gap();
  if (const std::string words = study_->device_words(); !words.empty()) ImGui::TextWrapped("%s", words.c_str());
  if (study_->needs_zeroing()) button("Zero here (Z)", GLFW_KEY_Z);
  if (!study_->device_pushes()) {
    draw_warning(
        "This device renders no force. This is a rehearsal; its answers are marked and excluded from the analysis.");
  }
  ImGui::End();
  ui_->end_frame();
}

// A button with the same effect as its key.
void StudyApp::button(const char* label, int key) {
  if (ImGui::Button(label)) press_key(key);
}

void StudyApp::draw_warning(const std::string& words) const {
  ImGui::PushStyleColor(ImGuiCol_Text, paint(style_.colours().fault));
  ImGui::TextWrapped("%s", words.c_str());
  ImGui::PopStyleColor();
}

void StudyApp::draw_entry() {
  const StrokePair* strokes = study_->strokes();
  ImGui::PushFont(style_.fonts().heading);
  ImGui::TextWrapped("%s", strokes == nullptr                     ? "How small a difference can a hand feel?"
                           : strokes->reference == kRecordedForce ? "Can a hand tell the model from the block?"
                                                                  : "Can a hand tell one model from the other?");
  ImGui::PopFont();
  ImGui::Spacing();
  ImGui::TextWrapped("%s The code stands for the person; no name is kept.",
                     strokes != nullptr
                         ? "Three pushes, one after the other: which of the last two was like the first? 100 trials."
                         : "Two pushes, one after the other: which was larger? 320 trials.");
  gap();
  ImGui::PushFont(style_.fonts().heading);
  draw_code();
  gap();
  button("Begin (Enter)", GLFW_KEY_ENTER);
  ImGui::PopFont();
  ImGui::TextDisabled("A code that has begun goes on after its last answer.");
  if (!problem_.empty()) draw_warning(problem_);
}

void StudyApp::draw_code() {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 padding = ImGui::GetStyle().FramePadding;
  const float width = 8.0F * ImGui::GetFontSize(), height = ImGui::GetFrameHeight();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + width, at.y + height}, ink(style_.colours().raised), ImGui::GetStyle().FrameRounding);
  list.AddText({at.x + padding.x, at.y + padding.y}, ink(style_.colours().text), (code_ + "|").c_str());
  ImGui::Dummy({width, height});
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("subject code, such as S01");
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
  ImGui::TextWrapped("%s", view.message.c_str());
  if (view.was_correct && view.training && view.state == StudyState::presenting && view.interval < 0)
    ImGui::TextDisabled(*view.was_correct ? "The last answer was right." : "The last answer was wrong.");
  gap();
  if (view.state == StudyState::presenting || view.state == StudyState::answering) draw_intervals(view);
  draw_choices(view);
  if (view.state == StudyState::done) draw_result();
  ImGui::PopFont();
}

// Draws a box for each push, the reference included if there is one, and highlights the current one.
void StudyApp::draw_intervals(const StudyView& view) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  ImFont* font = style_.fonts().big;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float side = 2.4F * height_of(font);
  float x = at.x;
  for (int interval = study_->strokes() != nullptr ? 0 : 1; interval <= 2; ++interval, x += 1.3F * side) {
    const bool on = view.interval == interval;
    list.AddRectFilled({x, at.y}, {x + side, at.y + side},
                       ink(on ? reference_colour(style_.theme()) : style_.colours().raised), 10.0F);
    const char text[2] = {"R12"[interval], '\0'};
    const ImVec2 size = font->CalcTextSizeA(height_of(font), 1e6F, 0.0F, text);
    list.AddText(font, height_of(font), {x + 0.5F * (side - size.x), at.y + 0.5F * (side - size.y)},
                 ink(style_.colours().text), text);
  }
  ImGui::Dummy({x - at.x, side});
  gap();
}

void StudyApp::draw_choices(const StudyView& view) {
  if (view.rest_ticks_left > 0) {
    ImGui::TextDisabled("%llu s left", static_cast<unsigned long long>((view.rest_ticks_left + 999) / 1000));
  } else {
    for (const Choice& choice : kChoices) {
      if (choice.state != view.state) continue;
      button(choice.label, choice.key);
      ImGui::SameLine();
    }
    ImGui::NewLine();
  }
  if (view.state == StudyState::done || view.state == StudyState::aborted) return;
  gap();
  ImGui::PushFont(style_.fonts().body);
  button("End the session (Esc)", GLFW_KEY_ESCAPE);
  ImGui::PopFont();
}

// Draws the result of a discrimination of strokes beside the prediction.
void StudyApp::draw_result() {
  const StrokePair* strokes = study_->strokes();
  if (strokes == nullptr) return;
  const StudyFile& file = session()->file();
  ImGui::Spacing();
  ImGui::TextWrapped("%s against %s, %s", strokes->comparison.c_str(), strokes->reference.c_str(),
                     strokes->recording.c_str());
  ImGui::TextWrapped(
      "%s",
      discrimination_verdict(discrimination_of(file.header().subject, file.records(), *strokes), *strokes).c_str());
}

}  // namespace palpate
