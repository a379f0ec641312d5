// The operating system's window with an OpenGL 3.3 core context, and the pace of
// its frames.
//
// Thread guarantee: main thread only (GLFW).
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "engine/base/result.h"
#include "rendering/ui/ui_style.h"

struct GLFWwindow;

namespace palpate {

struct WindowRequest {
  int width = 1280;
  int height = 720;
  bool fullscreen = false;
  Rgb empty{0.08F, 0.09F, 0.10F};  // its colour until the first picture
};

// What is drawn into.
struct Framebuffer {
  int width = 0;  // pixels
  int height = 0;
  float content_scale = 1.0F;  // how much larger than usual the display wants its contents
  int window_width = 0;        // the same in the window's own units
  int window_height = 0;
};

class Window {
 public:
  // Whether there is a display at all; cheap, before anything else starts. Errors:
  // there is none.
  static Status find_display();
  // After `find_display`. Errors, in one sentence: no OpenGL 3.3.
  static Result<std::unique_ptr<Window>> open(const WindowRequest& request);
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window();

  GLFWwindow* handle() const noexcept { return window_; }
  Framebuffer framebuffer() const noexcept;
  UiSize ui_size() const noexcept;
  // Shows what was drawn and waits until the next frame is due: the display's own
  // pace where the driver waits for it, else 60 Hz.
  void show_frame();
  // Likewise, and saves it as a PNG file, whole or not at all. Errors: it exists and
  // `overwrite` is false; the disk refuses.
  Status save_frame(const std::string& path, bool overwrite);

 private:
  explicit Window(GLFWwindow* window) : window_(window) {}
  bool display_sets_pace(const Rgb& empty);

  GLFWwindow* window_;
  bool paced_by_display_ = false;
  std::int64_t next_frame_ns_ = 0;
};

}  // namespace palpate
