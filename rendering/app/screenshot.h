// The window's picture as a PNG file.
// Thread guarantee: the thread of the OpenGL context.
#pragma once

#include <string>

#include "engine/base/result.h"
#include "rendering/app/window.h"

namespace palpate {

// What was drawn and is not shown yet; then shows it. The file is whole or not
// there. Errors: it exists and `overwrite` is false; the disk refuses.
Status save_screenshot(Window& window, const std::string& path, bool overwrite);

}  // namespace palpate
