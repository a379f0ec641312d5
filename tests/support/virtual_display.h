// A virtual display for tests of the window: Xvfb with software rendering, the
// same on every machine.
#pragma once

#include <string>

namespace palpate::test {

// The first call starts a display for this process and sets DISPLAY; it ends with
// the process. Returns its name, or an empty string if Xvfb does not start.
const std::string& virtual_display();

}  // namespace palpate::test
