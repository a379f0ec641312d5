// The window of the studies, the JND (--scene jnd_study) and two strokes to tell apart
// (--discriminate): who takes part, then one screen after the other, in words that a
// subject reads at a glance.
//
// Every button has a key; Esc ends the session at any time, and what was answered
// is kept. No curve and no number that could be an answer is shown before the end.
// Thread guarantee: main thread only.
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
  std::shared_ptr<const StrokePair> strokes;  // to tell apart; null: the JND study
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

  // What the entry screen does: opens or takes up study-CODE.csv, or with strokes
  // discriminate-CODE.csv, in this folder. Trouble is shown there.
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
  // Keys and letters since the last frame, in order: Enter comes after the code. (A text
  // field of Dear ImGui loses it now and then when frames are slow.)
  struct Typed {
    int key = 0;
    char letter = '\0';
  };
  std::vector<Typed> typed_;
  std::string code_;
  std::string problem_;
  bool can_be_felt_ = false;  // the device renders force
};

}  // namespace palpate
