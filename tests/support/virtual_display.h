// A virtual display for tests of the window: Xvfb with software rendering, the
// same on every machine.
#pragma once

#include <string>

struct GLFWwindow;

namespace palpate::test {

// The first call starts a display for this process and sets DISPLAY; it ends with
// the process. Returns its name, or an empty string if Xvfb does not start.
const std::string& virtual_display();

// A window with a current context of OpenGL 3.3 on that display; null, after a failure of the test, where there is
// none. End it with glfwDestroyWindow and glfwTerminate.
GLFWwindow* open_gl_window(int width, int height);

// Presses or releases the left button over the window; GLFW reports it as held in between.
void send_left_button(GLFWwindow* window, bool down);

// A display of its own, for a program that loses it.
class OwnDisplay {
 public:
  OwnDisplay();
  OwnDisplay(const OwnDisplay&) = delete;
  OwnDisplay& operator=(const OwnDisplay&) = delete;
  ~OwnDisplay() { end(); }
  const std::string& name() const { return name_; }  // empty if Xvfb does not start
  void end();

 private:
  int process_ = 0;
  std::string name_;
};

}  // namespace palpate::test
