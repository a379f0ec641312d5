// The operating system's window with an OpenGL 3.3 core context, and its frame rate.
// Thread guarantee: main thread only (GLFW).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "rendering/ui/ui_style.h"
#include "rendering/ui/viewport.h"

struct GLFWwindow;

namespace palpate {

struct WindowRequest {
  int width = 1280, height = 720;
  bool fullscreen = false;
  Rgb empty{0.08F, 0.09F, 0.10F};  // colour until the first frame
};

// Whether OpenGL is a program instead of a graphics card. `renderer`: its name as OpenGL reports it.
bool is_software(std::string_view renderer) noexcept;

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
  // Fills the frame, or a part of it, with one colour.
  void clear(const Rgb& colour) const;
  void clear(const Viewport& part, const Rgb& colour) const;
  // Whether the frame is kept when it is shown, so that the next one may be drawn in parts: not while it changes its
  // size.
  bool keeps_frame() const noexcept { return keeps_frame_ && same_size_ >= kSettled; }
  // Shows the frame and waits for the next one: until the display is ready if the driver waits for it, else 1/60 s.
  // `changed`: the parts that differ from the last frame, for a window that keeps it.
  void show_frame(const std::vector<Viewport>& changed);
  void show_frame();
  // Saves the frame as a PNG file and shows it. Errors: the file exists and `overwrite` is false; it cannot be written.
  Status save_frame(const std::string& path, bool overwrite);

 private:
  explicit Window(GLFWwindow* window) : window_(window) {}
  bool display_sets_pace(const Rgb& empty);
  bool has_settled();

  static constexpr int kSettled = 10;  // frames of the same size

  GLFWwindow* window_;
  bool keeps_frame_ = false;
  Viewport settled_;   // size of the last frame
  int same_size_ = 0;  // frames since it has changed
  bool paced_by_display_ = false;
  std::int64_t next_frame_ns_ = 0;
};

}  // namespace palpate
