// A display of its own for tests of the window: Xvfb, drawn on by software, the
// same on every machine.
#pragma once

#include <string>

namespace palpate::test {

// Starts one for this process, the first time, and sets DISPLAY to it; ends it
// with the process. Returns its name, empty when Xvfb does not start.
const std::string& virtual_display();

}  // namespace palpate::test
