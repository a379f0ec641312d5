// The window of the studies: the JND (--scene jnd_study) and the discrimination of two strokes (--discriminate). It
// asks for the subject code and then shows the screens of the session.
// Every button has a key. Esc ends the session at any time; the answers are kept. Nothing that could reveal an answer
// is shown before the end. Thread guarantee: main thread only.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "rendering/app/window.h"
#include "rendering/ui/ui_context.h"
#include "rendering/ui/ui_style.h"
#include "scenes/study/live_study.h"

namespace palpate {

struct StudyRequest {
  std::string device = "auto";
  WindowRequest window;
  bool realtime = true;
  std::shared_ptr<const StrokePair> strokes;  // of the discrimination; null: the JND study
};

class StudyApp {
 public:
  // Errors: those of Window.
  static Result<std::unique_ptr<StudyApp>> create(const StudyRequest& request);
  StudyApp(const StudyApp&) = delete;
  StudyApp& operator=(const StudyApp&) = delete;
  ~StudyApp();

  void frame();
  bool closing() const noexcept;
  Status screenshot(const std::string& path, bool overwrite);

  // Creates or resumes study-CODE.csv, or with strokes discriminate-CODE.csv, in the working directory. The entry
  // screen shows errors, see `problem`.
  void begin(const std::string& code);
  void press_key(int key) { typed_.push_back({key, '\0'}); }
  void type(char letter) { typed_.push_back({0, letter}); }
  // Null before `begin` succeeded.
  LiveStudy* study() noexcept { return study_.get(); }
  const std::string& problem() const noexcept { return problem_; }

 private:
  explicit StudyApp(const StudyRequest& request) : request_(request) {}
  void draw();
  void draw_entry();
  void draw_code();
  void draw_session();
  void draw_choices(const StudyView& view);
  void draw_intervals(const StudyView& view);
  void draw_result();
  void draw_trouble(const std::string& words) const;
  void handle_keys();
  void handle_key(int key);
  void handle_entry_key(int key);
  void button(const char* label, int key);

  StudyRequest request_;
  std::unique_ptr<Window> window_;
  std::unique_ptr<LiveStudy> study_;
  std::unique_ptr<UiContext> ui_;
  UiStyle style_;
  // Keys and letters since the last frame, in order. (A text field of Dear ImGui sometimes loses the Enter after the
  // code when frames are slow.)
  struct Typed {
    int key = 0;
    char letter = '\0';
  };
  std::vector<Typed> typed_;
  std::string code_;
  std::string problem_;
  bool can_be_felt_ = false;  // the device renders force to a person
};

}  // namespace palpate
