#include "tests/support/virtual_display.h"

#include <GLFW/glfw3.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <utility>

// After all others, because X11 defines macros with common names.
#define GLFW_EXPOSE_NATIVE_X11
#include <GLFW/glfw3native.h>

namespace palpate::test {
namespace {

// Becomes Xvfb, which selects a free display number, writes it to `descriptor`, and ends with the process `parent`.
[[noreturn]] void become_server(int descriptor, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(1);
  const int silence = open("/dev/null", O_WRONLY);
  dup2(silence, STDOUT_FILENO);
  dup2(silence, STDERR_FILENO);
  const std::string number = std::to_string(descriptor);
  // Without -noreset it restarts after the last window closes and misses new connections meanwhile.
  execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "1920x1080x24", "-nolisten", "tcp", "-noreset",
         nullptr);
  _exit(127);
}

// Returns the name of the display, or an empty string. `process`: receives the id of the server.
std::string start_server(pid_t& process) {
  int ends[2];
  if (pipe(ends) != 0) return {};
  const pid_t parent = getpid();
  process = fork();
  if (process == 0) become_server(ends[1], parent);
  close(ends[1]);
  std::string number;
  char byte = 0;
  while (read(ends[0], &byte, 1) == 1 && byte != '\n') number += byte;
  close(ends[0]);
  return number.empty() ? "" : ":" + number;
}

}  // namespace

const std::string& virtual_display() {
  static pid_t server = 0;
  static const std::string name = start_server(server);
  if (!name.empty()) {
    setenv("DISPLAY", name.c_str(), 1);
    unsetenv("WAYLAND_DISPLAY");
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  }
  return name;
}

GLFWwindow* open_gl_window(int width, int height) {
  EXPECT_FALSE(virtual_display().empty()) << "Xvfb does not start; apt-get install xvfb";
  EXPECT_EQ(glfwInit(), GLFW_TRUE);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  GLFWwindow* window = glfwCreateWindow(width, height, "test", nullptr, nullptr);
  EXPECT_NE(window, nullptr);
  if (window != nullptr) glfwMakeContextCurrent(window);
  return window;
}

void send_left_button(GLFWwindow* window, bool down) {
  double x = 0.0, y = 0.0;
  glfwGetCursorPos(window, &x, &y);
  XEvent event{};
  event.xbutton.type = down ? ButtonPress : ButtonRelease;
  event.xbutton.display = glfwGetX11Display();
  event.xbutton.window = glfwGetX11Window(window);
  event.xbutton.button = Button1;
  event.xbutton.x = static_cast<int>(x);
  event.xbutton.y = static_cast<int>(y);
  event.xbutton.same_screen = True;
  XSendEvent(event.xbutton.display, event.xbutton.window, False, NoEventMask, &event);
  XSync(event.xbutton.display, False);
}

OwnDisplay::OwnDisplay() { name_ = start_server(process_); }

void OwnDisplay::end() {
  if (process_ <= 0) return;
  kill(process_, SIGTERM);
  waitpid(std::exchange(process_, 0), nullptr, 0);
}

}  // namespace palpate::test
