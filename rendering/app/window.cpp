#include "rendering/app/window.h"

#include <GLFW/glfw3.h>
#include <dlfcn.h>
#include <epoxy/gl.h>
#include <png.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/files.h"
#include "engine/live/pacer.h"

namespace palpate {
namespace {

constexpr std::int64_t kFrame_ns = 1'000'000'000 / 60;
// Empty frames that test whether the driver waits for the display. If it does, each takes at least 5 ms at display
// rates up to 200 Hz.
constexpr int kTrialFrames = 6;
constexpr std::int64_t kWaited_ns = 5'000'000;
constexpr int kSmallestWidth = 800;
constexpr int kSmallestHeight = 480;

std::string last_problem;
std::function<void()> end_of_program;

void keep_problem(int, const char* text) { last_problem = text; }

// Called by Xlib, on any thread that draws. Does not return, because Xlib would then call exit().
[[noreturn]] void end_without_display(const char* why) {
  static std::atomic<bool> ending{false};
  while (ending.exchange(true)) pause();  // another thread ends the program
  try {
    if (end_of_program) end_of_program();
  } catch (const std::exception&) {  // the line below says what matters
  }
  std::fprintf(stderr, "error: %s; start the program again\n", why);
  std::fflush(nullptr);
  _exit(1);
}

int on_lost_server(void*) {
  end_without_display("the display is gone: its server has ended or the connection is closed");
}
int on_refused_request(void*, void*) { end_without_display("the display refused a request of the window"); }

// GLFW is linked to Xlib or, built for Wayland alone, not.
template <typename Handler>
void set_handler(const char* name, Handler handler) {
  using Set = Handler (*)(Handler);
  if (const auto set = reinterpret_cast<Set>(dlsym(RTLD_DEFAULT, name)); set != nullptr) set(handler);
}

constexpr std::size_t kChannels = 3;

Result<std::string> png_of(const std::vector<unsigned char>& pixels, const UiSize& picture) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width_px);
  image.height = static_cast<png_uint_32>(picture.height_px);
  image.format = PNG_FORMAT_RGB;
  // OpenGL's first row is the lowest; a negative stride flips the picture.
  const auto stride = -static_cast<png_int_32>(kChannels * image.width);
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string file(size, '\0');
  if (png_image_write_to_memory(&image, file.data(), &size, 0, pixels.data(), stride, nullptr) == 0)
    return Error{std::string("the picture cannot be made a PNG: ") + image.message};
  file.resize(size);
  return file;
}

// The free part of the screen that shows the upper left corner of the window, else of the primary screen.
Viewport free_part(const Viewport& window) {
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  Viewport found;
  for (int i = count - 1; i >= 0; --i) {  // the primary screen is the first
    Viewport part;
    glfwGetMonitorWorkarea(monitors[i], &part.x, &part.y, &part.width, &part.height);
    found = part;
    if (window.x >= part.x && window.x < part.x + part.width && window.y >= part.y && window.y < part.y + part.height)
      break;
  }
  return found;
}

// Shrinks and moves the window so that it and its frame are inside the screen.
void keep_on_screen(GLFWwindow* handle) {
  Viewport window;
  int left = 0, top = 0, right = 0, bottom = 0;  // of the frame
  glfwGetWindowPos(handle, &window.x, &window.y);
  glfwGetWindowSize(handle, &window.width, &window.height);
  glfwGetWindowFrameSize(handle, &left, &top, &right, &bottom);
  const Viewport room = free_part(window);
  const int width = std::min(window.width, room.width - left - right);
  const int height = std::min(window.height, room.height - top - bottom);
  if (width <= 0 || height <= 0) return;  // no screen is known
  if (width != window.width || height != window.height) glfwSetWindowSize(handle, width, height);
  const int x = std::clamp(window.x, room.x + left, room.x + room.width - right - width);
  const int y = std::clamp(window.y, room.y + top, room.y + room.height - bottom - height);
  if (x != window.x || y != window.y) glfwSetWindowPos(handle, x, y);
}

// The display asks for no scale, or for one that no display has.
bool scale_is_usable(float scale) { return scale > 0.2F && scale < 10.0F; }

// Whether OpenGL is a program, of Mesa (three), Microsoft or Apple, instead of a graphics card.
bool is_software(std::string_view renderer) noexcept {
  constexpr std::string_view kPrograms[] = {"llvmpipe", "softpipe", "SWR", "GDI Generic", "Software"};
  return std::ranges::any_of(kPrograms, [&](auto name) { return renderer.find(name) != renderer.npos; });
}

}  // namespace

Status Window::find_display() {
  glfwSetErrorCallback(keep_problem);
  set_handler("XSetIOErrorHandler", &on_lost_server);
  if (glfwInit() == GLFW_TRUE) return {};
  return Error{"no display (" + last_problem +
               "), expected an X11 or Wayland session; run it on a desktop, under xvfb-run, or use `palpate` "
               "without a window"};
}

void Window::at_loss_of_display(std::function<void()> end) { end_of_program = std::move(end); }

Result<std::unique_ptr<Window>> Window::open(const WindowRequest& request) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  float screen_scale = 0.0F;
  if (GLFWmonitor* primary = glfwGetPrimaryMonitor()) glfwGetMonitorContentScale(primary, &screen_scale, nullptr);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, scale_is_usable(screen_scale) ? GLFW_TRUE : GLFW_FALSE);
  GLFWmonitor* monitor = request.fullscreen ? glfwGetPrimaryMonitor() : nullptr;
  const GLFWvidmode* mode = monitor != nullptr ? glfwGetVideoMode(monitor) : nullptr;
  GLFWwindow* handle = glfwCreateWindow(mode != nullptr ? mode->width : request.width,
                                        mode != nullptr ? mode->height : request.height, "Palpate", monitor, nullptr);
  if (handle == nullptr) {
    const Error error{"no window with OpenGL 3.3 (" + last_problem +
                      "); update the graphics driver, or set LIBGL_ALWAYS_SOFTWARE=1 to draw without one"};
    glfwTerminate();
    return error;
  }
  glfwSetWindowSizeLimits(handle, kSmallestWidth, kSmallestHeight, GLFW_DONT_CARE, GLFW_DONT_CARE);
  if (monitor == nullptr) keep_on_screen(handle);
  glfwMakeContextCurrent(handle);
  if (epoxy_gl_version() < 33) {
    const Error error{"found OpenGL " + std::to_string(epoxy_gl_version() / 10) + "." +
                      std::to_string(epoxy_gl_version() % 10) + ", expected 3.3; update the graphics driver"};
    glfwDestroyWindow(handle);
    glfwTerminate();
    return error;
  }
  set_handler("XSetErrorHandler", &on_refused_request);  // GLFW resets it while it makes a context
  std::unique_ptr<Window> window(new Window(handle));
  const bool software = is_software(reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
  // A software renderer does not wait; on a busy machine its frames would seem to.
  window->paced_by_display_ = window->display_sets_pace(request.empty) && !software;
  return window;
}

Window::~Window() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

bool Window::display_sets_pace(const Rgb& empty) {
  glfwSwapInterval(1);
  clear(empty);
  glfwSwapBuffers(window_);
  glFinish();
  const std::int64_t start_ns = steady_now_ns();
  for (int i = 0; i < kTrialFrames; ++i) {
    // Only a corner is drawn, so that the time is that of the driver's wait.
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, 8, 8);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
    glfwSwapBuffers(window_);
    glFinish();
  }
  return steady_now_ns() - start_ns > kTrialFrames * kWaited_ns;
}

UiSize Window::size() const noexcept {
  UiSize size;
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &size.width_px, &size.height_px);
  glfwGetWindowSize(window_, &width, &height);
  if (size.width_px == 0 || width == 0) return {};
  size.width = static_cast<float>(width);
  size.height = static_cast<float>(height);
  size.pixels_per_unit = static_cast<float>(size.width_px) / size.width;
  glfwGetWindowContentScale(window_, &size.content_scale, nullptr);
  if (!scale_is_usable(size.content_scale)) size.content_scale = 1.0F;
  return size;
}

bool Window::is_visible() const noexcept {
  constexpr int kLeast_px = 64;  // less than two lines of text
  const UiSize all = size();
  return all.width_px >= kLeast_px && all.height_px >= kLeast_px;
}

void Window::clear(const Rgb& colour) const {
  const UiSize all = size();
  glViewport(0, 0, all.width_px, all.height_px);
  glClearColor(colour.r, colour.g, colour.b, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT);
}

Status Window::save_frame(const std::string& path, bool overwrite) {
  const UiSize picture = size();
  std::vector<unsigned char> pixels(kChannels * static_cast<std::size_t>(picture.width_px) *
                                    static_cast<std::size_t>(picture.height_px));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadBuffer(GL_BACK);
  glReadPixels(0, 0, picture.width_px, picture.height_px, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
  const Result<std::string> png = png_of(pixels, picture);
  show_frame();
  if (!png) return png.error();
  return write_file_atomically(path, *png, overwrite);
}

void Window::show_frame() {
  constexpr double kLongest_s = 0.1;
  glfwSwapBuffers(window_);
  SteadyPacer clock;
  if (!paced_by_display_) {
    // After a late frame the schedule starts again, so that no burst of frames follows.
    next_frame_ns_ = std::max(next_frame_ns_ + kFrame_ns, clock.now_ns());
    clock.wait_until(next_frame_ns_);
  }
  const std::int64_t before_ns = std::exchange(shown_ns_, clock.now_ns());
  frame_s_ = std::min(1e-9 * static_cast<double>(shown_ns_ - before_ns), kLongest_s);
}

}  // namespace palpate
