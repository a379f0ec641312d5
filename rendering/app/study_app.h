// The window of the studies: the JND (--scene jnd_study) and the discrimination of two strokes (--discriminate). It
// asks for the subject code and then shows the screens of the session.
// Every button has a key. Esc asks whether to end the session, at any time; the answers are kept. Nothing that could
// reveal an answer is shown, the result of the subject included: palpate study analyse prints it. Thread guarantee:
// main thread only.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "rendering/app/window.h"
#include "rendering/ui/ui.h"
#include "scenes/study/study_session.h"

namespace palpate {

class StudyApp {
 public:
  // `prepare`: makes the strokes of the discrimination, which takes some seconds, while the window says so; null: the
  // JND study. Errors: those of Window and `prepare`; the device cannot be opened.
  using Strokes = Result<std::shared_ptr<const StrokePair>>;
  static Result<std::unique_ptr<StudyApp>> create(const WindowRequest& asked, const std::string& device,
                                                  const std::function<Strokes()>& prepare, bool realtime = true);
  ~StudyApp() { Window::at_loss_of_display(nullptr); }

  void frame();
  bool closing() const noexcept;
  Status screenshot(const std::string& path, bool overwrite);

  // The effect of a key or a letter; keys of GLFW. A key counts once, in the next frame.
  void press_key(int key);
  void type(char letter);
  // Null before a valid code was entered; until then the screen shows `problem`.
  StudySession* session() noexcept { return study_->session(); }
  const std::string& problem() const noexcept { return problem_; }

 private:
  StudyApp() = default;
  void draw();
  void draw_study();
  void draw_entry();
  void draw_session();
  void draw_end();
  void draw_intervals(const StudyView& view);
  void draw_choices(const StudyView& view);
  bool button(const char* label, int key, ImVec2 size = {});

  std::unique_ptr<Window> window_;
  std::unique_ptr<LiveStudy> study_;
  std::unique_ptr<UiContext> ui_;
  UiStyle style_;
  std::vector<int> pressed_;  // since the last frame
  bool asks_end_ = false;     // whether to end the session
  double slip_left_s_ = 0.0;  // an answer within it is a slip of the finger
  StudyState last_ = StudyState::consent;
  // The code so far. With slow frames a text field of Dear ImGui sometimes loses the Enter after the code.
  std::string code_, problem_;
};

}  // namespace palpate
