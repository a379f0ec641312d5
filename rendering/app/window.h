// The operating system's window with an OpenGL 3.3 core context, and its frame rate.
// Thread guarantee: main thread only (GLFW).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "engine/base/result.h"
#include "rendering/ui/ui.h"

struct GLFWwindow;

namespace palpate {

struct WindowRequest {
  int width = 1280, height = 720;
  bool fullscreen = false;
  Rgb empty{0.08F, 0.09F, 0.10F};  // colour until the first frame
};

class Window {
 public:
  // Checks for a display; fast. Call it first. Errors: there is none.
  static Status find_display();
  // Sets what happens when the X server goes away, or refuses a request, in place of the last one; null: nothing. The
  // handlers of Xlib call exit(), which would destroy what other threads still use. The program ends after `end`, which
  // must call neither GLFW nor OpenGL, with an `error:` line and exit code 1.
  static void at_loss_of_display(std::function<void()> end);
  // Call it after `find_display`. Errors: no window with OpenGL 3.3.
  static Result<std::unique_ptr<Window>> open(const WindowRequest& request);
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window();

  GLFWwindow* handle() const noexcept { return window_; }
  UiSize size() const noexcept;
  // Whether the window is large enough for anything to be seen in it.
  bool is_visible() const noexcept;
  void clear(const Rgb& colour) const;
  // Shows the frame and waits for the next one: until the display is ready if the driver waits for it, else 1/60 s.
  void show_frame();
  // Duration of the last frame for what lasts a moment, at most 0.1 s: a slow frame does not cut it short.
  double frame_s() const noexcept { return frame_s_; }
  // Saves the frame as a PNG file and shows it. Errors: the file exists and `overwrite` is false; it cannot be written.
  Status save_frame(const std::string& path, bool overwrite);

 private:
  explicit Window(GLFWwindow* window) : window_(window) {}
  bool display_sets_pace(const Rgb& empty);

  GLFWwindow* window_;
  bool paced_by_display_ = false;
  std::int64_t next_frame_ns_ = 0, shown_ns_ = 0;
  double frame_s_ = 0.0;
};

}  // namespace palpate
