#include "rendering/app/study_app.h"

#include <epoxy/gl.h>
// GLFW after epoxy, which declares the functions of OpenGL.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cctype>
#include <iterator>
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
    {StudyState::answering, GLFW_KEY_2, "The second (2)", [](StudySession& session) { session.answer(true); }},
    {StudyState::unsaved, GLFW_KEY_R, "Try again (R)", [](StudySession& session) { session.retry(); }}};

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
  std::unique_ptr<StudyApp> app(new StudyApp(request));
  app->window_ = std::move(*window);
  app->can_be_felt_ = study_can_be_felt(request.device);
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

StudyApp::~StudyApp() { study_.reset(); }

bool StudyApp::closing() const noexcept { return glfwWindowShouldClose(window_->handle()) != 0; }

void StudyApp::begin(const std::string& code) {
  LiveStudyRequest request;
  request.device = request_.device;
  request.realtime = request_.realtime;
  request.header.subject = code;
  request.path = "study-" + code + ".csv";
  if (request_.strokes != nullptr) {
    request.header.strokes = request_.strokes;
    request.path = "discriminate-" + code + ".csv";
  }
  problem_.clear();
  auto study = LiveStudy::open(request);
  if (study) {
    study_ = std::move(*study);
  } else {
    problem_ = study.error().message;
  }
}

void StudyApp::frame() {
  glfwPollEvents();
  if (study_ != nullptr) study_->update();
  handle_keys();
  draw();
  window_->show_frame();
}

void StudyApp::handle_keys() {
  for (const Typed& typed : std::exchange(typed_, {})) {
    if (study_ == nullptr && typed.key == 0) {
      if (code_.size() < kLongestCode && std::isalnum(static_cast<unsigned char>(typed.letter)) != 0) {
        code_ += static_cast<char>(std::toupper(static_cast<unsigned char>(typed.letter)));
      }
    } else if (study_ == nullptr) {
      handle_entry_key(usual_key(typed.key));
    } else {
      handle_key(usual_key(typed.key));
    }
  }
}

void StudyApp::handle_entry_key(int key) {
  if (key == GLFW_KEY_ENTER) begin(code_);
  if (key == GLFW_KEY_BACKSPACE && !code_.empty()) code_.pop_back();
}

void StudyApp::handle_key(int key) {
  StudySession& session = study_->session();
  if (key == GLFW_KEY_ESCAPE) session.abort();
  if (key == GLFW_KEY_Z) study_->start_zeroing();
  const auto asked = [&](const Choice& choice) { return choice.state == session.state() && choice.key == key; };
  if (const auto* choice = std::find_if(std::begin(kChoices), std::end(kChoices), asked); choice != std::end(kChoices))
    choice->run(session);
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
  if (study_ == nullptr) {
    draw_entry();
  } else {
    draw_session();
  }
  ImGui::End();
  ui_->end_frame();
}

// A button with the same effect as its key.
void StudyApp::button(const char* label, int key) {
  if (ImGui::Button(label)) press_key(key);
}

void StudyApp::draw_trouble(const std::string& words) const {
  ImGui::PushStyleColor(ImGuiCol_Text, paint(style_.colours().fault));
  ImGui::TextWrapped("%s", words.c_str());
  ImGui::PopStyleColor();
}

void StudyApp::draw_entry() {
  ImGui::PushFont(style_.fonts().heading);
  ImGui::TextWrapped("%s", request_.strokes == nullptr ? "How small a difference can a hand feel?"
                           : request_.strokes->reference == kRecordedForce
                               ? "Can a hand tell the model from the block?"
                               : "Can a hand tell one model from the other?");
  ImGui::PopFont();
  ImGui::Spacing();
  ImGui::TextWrapped("%s The code stands for the person; no name is kept.",
                     request_.strokes != nullptr
                         ? "Three pushes, one after the other: which of the last two was like the first? 100 trials."
                         : "Two pushes, one after the other: which was larger? 320 trials.");
  gap();
  ImGui::PushFont(style_.fonts().heading);
  draw_code();
  ImGui::PopFont();
  gap();
  ImGui::PushFont(style_.fonts().heading);
  button("Begin (Enter)", GLFW_KEY_ENTER);
  ImGui::PopFont();
  ImGui::TextDisabled("A code that has begun goes on after its last answer.");
  if (!can_be_felt_) draw_trouble(kRehearsal);
  if (!problem_.empty()) draw_trouble(problem_);
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
  const StudyView view = study_->session().view();
  if (view.trials > 0 && view.state != StudyState::consent) {
    ImGui::TextDisabled("%s   %zu of %zu", view.training ? "training" : "study", view.answered, view.trials);
    const float share = static_cast<float>(view.answered) / static_cast<float>(view.trials);
    ImGui::ProgressBar(share, {-1.0F, 0.4F * ImGui::GetFontSize()}, "");
  }
  ImGui::Spacing();
  ImGui::PushFont(style_.fonts().heading);
  ImGui::TextWrapped("%s", view.message.c_str());
  if (view.has_feedback && view.training && view.state == StudyState::presenting && view.interval == 0 &&
      !view.reminder) {
    ImGui::TextDisabled(view.was_correct ? "The last answer was right." : "The last answer was wrong.");
  }
  gap();
  if (view.state == StudyState::presenting || view.state == StudyState::answering) draw_intervals(view);
  draw_choices(view);
  if (view.state == StudyState::done) draw_result();
  ImGui::PopFont();
  gap();
  if (const std::string words = study_->device_words(); !words.empty()) ImGui::TextWrapped("%s", words.c_str());
  if (study_->newest().device.zeroing == Zeroing::needed) button("Zero here (Z)", GLFW_KEY_Z);
  if (!study_->device_pushes()) draw_trouble(kRehearsal);
}

// Draws the result of a discrimination of strokes beside the prediction.
void StudyApp::draw_result() {
  if (request_.strokes == nullptr) return;
  const StudySession& session = study_->session();
  const Discrimination result =
      discrimination_of(session.header().subject, session.store().records(), *request_.strokes);
  ImGui::Spacing();
  ImGui::TextWrapped("%s against %s, %s", request_.strokes->comparison.c_str(), request_.strokes->reference.c_str(),
                     request_.strokes->recording.c_str());
  ImGui::TextWrapped("%s", discrimination_verdict(result, *request_.strokes).c_str());
}

// Draws a box for each push, the reference included if there is one, and highlights the current one.
void StudyApp::draw_intervals(const StudyView& view) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  ImFont* font = style_.fonts().big;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float side = 2.4F * height_of(font);
  const int first = view.has_reminder ? 0 : 1;
  for (int interval = first; interval <= 2; ++interval) {
    const float x = at.x + 1.3F * side * static_cast<float>(interval - first);
    const bool on = interval == 0 ? view.reminder : view.interval == interval;
    list.AddRectFilled({x, at.y}, {x + side, at.y + side}, ink(on ? kReferenceColour : style_.colours().raised), 10.0F);
    const char text[2] = {interval == 0 ? 'R' : static_cast<char>('0' + interval), '\0'};
    const ImVec2 size = font->CalcTextSizeA(height_of(font), 1e6F, 0.0F, text);
    list.AddText(font, height_of(font), {x + 0.5F * (side - size.x), at.y + 0.5F * (side - size.y)},
                 ink(style_.colours().text), text);
  }
  ImGui::Dummy({(view.has_reminder ? 3.6F : 2.3F) * side, side});
  gap();
}

void StudyApp::draw_choices(const StudyView& view) {
  bool first = true;
  for (const Choice& choice : kChoices) {
    if (choice.state != view.state || view.rest_ticks_left > 0) continue;
    if (!std::exchange(first, false)) ImGui::SameLine();
    button(choice.label, choice.key);
  }
  if (view.rest_ticks_left > 0)
    ImGui::TextDisabled("%llu s left", static_cast<unsigned long long>((view.rest_ticks_left + 999) / 1000));
  if (view.state == StudyState::done || view.state == StudyState::aborted) return;
  gap();
  ImGui::PushFont(style_.fonts().body);
  button("End the session (Esc)", GLFW_KEY_ESCAPE);
  ImGui::PopFont();
}

Status StudyApp::screenshot(const std::string& path, bool overwrite) {
  draw();
  return window_->save_frame(path, overwrite);
}

}  // namespace palpate
